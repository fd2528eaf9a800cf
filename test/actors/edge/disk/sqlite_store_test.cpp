#include "actors/edge/disk/sqlite_store.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>

using namespace roscell;
using namespace roscell::test;

namespace {

using records = std::vector<sqlite_store::record>;

/// Bounds the files that this process may write, like a disk that is full.
class small_files {
public:
  explicit small_files(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit bound{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &bound);
  }

  ~small_files() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

  small_files(const small_files&) = delete;
  small_files& operator=(const small_files&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

records load(sqlite_store& store, const std::string& table) {
  return value_of(store.load(table));
}

} // namespace

TEST_CASE("a record outlives its store") {
  temp_folder folder;
  const auto file = folder.path() / "state.db";
  {
    auto store = value_of(sqlite_store::open(file));
    CHECK_FALSE(store.put("tasks", "b", "2"));
    CHECK_FALSE(store.put("tasks", "a", "1"));
    CHECK_FALSE(store.put("tasks", "b", "3"));
    CHECK_FALSE(store.put("identity", "a", std::string{"x\0y", 3}));
  }
  auto store = value_of(sqlite_store::open(file));
  CHECK(load(store, "tasks") == records{{"a", "1"}, {"b", "3"}});
  CHECK(load(store, "identity") == records{{"a", std::string{"x\0y", 3}}});
  CHECK(load(store, "none").empty());
}

TEST_CASE("a removed record is gone, and removing none is no error") {
  temp_folder folder;
  auto store = value_of(sqlite_store::open(folder.path() / "state.db"));
  CHECK_FALSE(store.put("t", "k", "v"));
  CHECK_FALSE(store.remove("t", "k"));
  CHECK_FALSE(store.remove("t", "k"));
  CHECK(load(store, "t").empty());
}

TEST_CASE("several records are written in their order") {
  temp_folder folder;
  auto store = value_of(sqlite_store::open(folder.path() / "state.db"));
  CHECK_FALSE(store.write({{"t", "a", "1"}, {"t", "b", "2"}}));
  CHECK_FALSE(
      store.write({{"t", "a", std::nullopt}, {"t", "b", "3"}, {"u", "c", ""}}));
  CHECK(load(store, "t") == records{{"b", "3"}});
  CHECK(load(store, "u") == records{{"c", ""}});
  CHECK_FALSE(store.write({}));
}

TEST_CASE("several records are written all or none") {
  temp_folder folder;
  auto store = value_of(sqlite_store::open(folder.path() / "state.db"));
  CHECK_FALSE(store.put("t", "old", "1"));
  std::vector<sqlite_store::change> changes{{"t", "old", std::nullopt}};
  for (int i = 0; i < 100; ++i)
    changes.push_back({"t", std::to_string(i), std::string(1000, 'v')});
  {
    const small_files limit{48 * 1024};
    const auto why = store.write(changes);
    REQUIRE(why);
    CHECK(why->message.find("no room is left") != std::string::npos);
    CHECK(load(store, "t") == records{{"old", "1"}});
  }
  CHECK_FALSE(store.put("t", "new", "2"));
  CHECK(load(store, "t") == records{{"new", "2"}, {"old", "1"}});
}

TEST_CASE("keys and values are data and never SQL") {
  temp_folder folder;
  auto store = value_of(sqlite_store::open(folder.path() / "state.db"));
  const std::string evil = "'); DROP TABLE records; --";
  CHECK_FALSE(store.put(evil, evil, evil));
  CHECK(load(store, evil) == records{{evil, evil}});
}

TEST_CASE("what a node records is for its owner only") {
  temp_folder folder;
  auto store = value_of(sqlite_store::open(folder.path() / "state.db"));
  CHECK_FALSE(store.put("t", "k", "v"));
  for (const auto* name : {"state.db", "state.db-wal"}) {
    struct stat about {};
    REQUIRE(::stat((folder.path() / name).c_str(), &about) == 0);
    CHECK((about.st_mode & 0777) == 0600);
  }
}

TEST_CASE("a store that another program holds is a conflict") {
  temp_folder folder;
  const auto file = folder.path() / "state.db";
  auto first = value_of(sqlite_store::open(file));
  const auto why = error_of(sqlite_store::open(file));
  CHECK(why.code == error_code::conflict);
  CHECK(why.message.find("in use") != std::string::npos);
}

TEST_CASE("a damaged file is named as such") {
  temp_folder folder;
  const auto file = folder.write("state.db", std::string(10'000, 'x'));
  const auto why = error_of(sqlite_store::open(file));
  CHECK(why.message.find("is damaged") != std::string::npos);
  CHECK_FALSE(why.hint.empty());
}

TEST_CASE("damage inside a file is found when it is opened") {
  temp_folder folder;
  const auto file = folder.path() / "state.db";
  {
    auto store = value_of(sqlite_store::open(file));
    for (int i = 0; i < 300; ++i)
      CHECK_FALSE(store.put("t", std::to_string(i), std::string(200, 'v')));
  }
  {
    std::fstream damage{file, std::ios::in | std::ios::out | std::ios::binary};
    damage.seekp(8 * 1024);
    damage << std::string(4 * 1024, '\xFF');
  }
  CHECK(error_of(sqlite_store::open(file)).message.find("is damaged")
        != std::string::npos);
}

TEST_CASE("a file of a newer version is not touched") {
  temp_folder folder;
  const auto file = folder.path() / "state.db";
  value_of(sqlite_store::open(file));
  {
    // Offset and size of the user version (SQLite file format, 1.3.15).
    std::fstream newer{file, std::ios::in | std::ios::out | std::ios::binary};
    newer.seekp(60);
    newer << std::string{"\0\0\0\3", 4};
  }
  CHECK(error_of(sqlite_store::open(file)).message.find("newer version")
        != std::string::npos);
}

TEST_CASE("a file of the version before is carried over") {
  temp_folder folder;
  const auto file = folder.path() / "state.db";
  {
    auto store = value_of(sqlite_store::open(file));
    CHECK_FALSE(store.put("tasks", "a", "1"));
  }
  {
    std::fstream older{file, std::ios::in | std::ios::out | std::ios::binary};
    older.seekp(60);
    older << std::string{"\0\0\0\1", 4};
  }
  {
    auto store = value_of(sqlite_store::open(file));
    CHECK(load(store, "tasks") == records{{"a", "1"}});
  }
  std::fstream now{file, std::ios::in | std::ios::binary};
  now.seekg(60);
  std::string version(4, '?');
  now.read(version.data(), 4);
  CHECK(version == std::string{"\0\0\0\2", 4});
}

TEST_CASE("a file is opened and read although the disk is full") {
  temp_folder folder;
  const auto file = folder.path() / "state.db";
  {
    auto store = value_of(sqlite_store::open(file));
    CHECK_FALSE(store.put("tasks", "a", "1"));
  }
  const small_files limit{0};
  auto store = value_of(sqlite_store::open(file));
  CHECK(load(store, "tasks") == records{{"a", "1"}});
  CHECK(store.put("tasks", "b", "2"));
  CHECK(load(store, "tasks") == records{{"a", "1"}});
}

TEST_CASE("a folder that cannot be written is told of") {
  if (::geteuid() == 0) {
    WARN("skipped: root may write everywhere");
    return;
  }
  temp_folder folder;
  ::chmod(folder.path().c_str(), 0500);
  const auto why = error_of(sqlite_store::open(folder.path() / "state.db"));
  CHECK(why.message.find("cannot be written") != std::string::npos);
}

TEST_CASE("a folder that is not there is told of") {
  const auto why = error_of(sqlite_store::open("/no/such/folder/state.db"));
  CHECK(why.message.find("cannot be written") != std::string::npos);
}

namespace {

bool mount_small_disk(const std::filesystem::path& folder) {
  return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0
         && ::mount("none", folder.c_str(), "tmpfs", 0, "size=256k") == 0;
}

/// Fills a file system of 256 KiB; returns what the store said.
std::optional<edge_error> fill_disk(const std::filesystem::path& folder) {
  if (!mount_small_disk(folder))
    return edge_error{error_code::internal, "skipped", {}};
  auto store = value_of(sqlite_store::open(folder / "state.db"));
  for (int i = 0; i < 1000; ++i)
    if (auto error = store.put("t", std::to_string(i), std::string(1000, 'v')))
      return error;
  return std::nullopt;
}

} // namespace

TEST_CASE("a full disk is told of by name") {
  temp_folder folder;
  std::optional<edge_error> why;
  // A thread with a mount namespace of its own: it goes with the thread.
  std::thread{[&] {
    if (::unshare(CLONE_NEWNS) == 0)
      why = fill_disk(folder.path());
    else
      why = edge_error{error_code::internal, "skipped", {}};
  }}.join();
  REQUIRE(why);
  if (why->message == "skipped") {
    WARN("skipped: no right to make a mount namespace");
    return;
  }
  CHECK(why->message.find("no room is left") != std::string::npos);
}

TEST_CASE("who gives way is asked for room until there is enough") {
  temp_folder folder;
  std::optional<edge_error> why;
  int asked = 0;
  std::thread{[&] {
    if (::unshare(CLONE_NEWNS) != 0 || !mount_small_disk(folder.path())) {
      why = edge_error{error_code::internal, "skipped", {}};
      return;
    }
    auto store = value_of(sqlite_store::open(folder.path() / "state.db"));
    constexpr size_t piece = 32 * 1024;
    for (const auto* name : {"0", "1", "2", "3", "4", "5", "6", "7", "8"})
      std::ofstream{folder.path() / name} << std::string(piece, 'x');
    store.set_room_maker([&] {
      return std::filesystem::remove(folder.path() / std::to_string(asked++));
    });
    why = store.put("t", "k", std::string(2 * piece, 'v'));
  }}.join();
  if (why && why->message == "skipped") {
    WARN("skipped: no right to make a mount namespace");
    return;
  }
  CHECK_FALSE(why);
  CHECK(asked > 0);
}
