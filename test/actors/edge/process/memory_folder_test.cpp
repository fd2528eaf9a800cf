#include "actors/edge/process/memory_folder.hpp"

#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

struct stat state_of_file(const fs::path& path) {
  struct stat info {};
  REQUIRE(::lstat(path.c_str(), &info) == 0);
  return info;
}

unsigned mode_of_file(const fs::path& path) {
  return state_of_file(path).st_mode & 07777U;
}

std::string content_of(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// A folder of this test in /dev/shm, gone with it.
struct shared_memory {
  shared_memory() {
    fs::remove_all(own);
  }
  ~shared_memory() {
    fs::remove_all(own);
  }

  fs::path lay_out(const std::string& program,
                   const memory_folder::file_list& files,
                   const std::string& user = {}) {
    const auto made = folder.lay_out(program, files, user);
    REQUIRE(std::holds_alternative<fs::path>(made));
    return std::get<fs::path>(made);
  }

  std::string name = "roscell-test-" + std::to_string(::getpid());
  fs::path own = fs::path{"/dev/shm"} / name;
  memory_folder folder{{"/dev/shm"}, name};
};

} // namespace

TEST_CASE("/dev/shm lies in memory, and the root folder does not",
          "[secrets]") {
  CHECK(is_in_memory("/dev/shm"));
  CHECK_FALSE(is_in_memory("/proc"));
  CHECK_FALSE(is_in_memory("/no/such/place"));
}

TEST_CASE("files of secrets can be read by their user, and by nobody else",
          "[secrets]") {
  shared_memory m;
  const std::string bytes{"a\0b\n", 4};
  const auto before = ::umask(0);
  const auto folder = m.lay_out("i", {{"key", bytes}, {"other", "x"}});
  ::umask(before);
  CHECK(folder == m.own / "i");
  CHECK(mode_of_file(folder) == 0700);
  CHECK(mode_of_file(folder / "key") == 0400);
  CHECK(content_of(folder / "key") == bytes);
  CHECK(mode_of_file(m.own) == 0711);
}

TEST_CASE("files of secrets belong to the user that a skill runs as",
          "[secrets]") {
  if (::geteuid() != 0) {
    WARN("skipped: only root can give files away");
    return;
  }
  shared_memory m;
  const auto folder = m.lay_out("i", {{"key", "x"}}, "nobody");
  const auto nobody = ::getpwnam("nobody")->pw_uid;
  CHECK(state_of_file(folder).st_uid == nobody);
  CHECK(state_of_file(folder / "key").st_uid == nobody);
  CHECK(mode_of_file(folder / "key") == 0400);
  CHECK(std::holds_alternative<edge_error>(
      m.folder.lay_out("i", {{"key", "x"}}, "nosuchuser")));
}

TEST_CASE("a program is given its files anew, and what was there is gone",
          "[secrets]") {
  shared_memory m;
  m.lay_out("i", {{"key", "old"}, {"gone", "x"}});
  const auto folder = m.lay_out("i", {{"key", "new"}});
  CHECK(content_of(folder / "key") == "new");
  CHECK_FALSE(fs::exists(folder / "gone"));
}

TEST_CASE("files of secrets go with their program, and those of others stay",
          "[secrets]") {
  shared_memory m;
  for (const auto* x : {"a", "b", "c"})
    m.lay_out(x, {{"key", "x"}});
  m.folder.clear("a");
  CHECK_FALSE(fs::exists(m.own / "a"));
  m.folder.clear_others({"b"});
  CHECK(fs::exists(m.own / "b/key"));
  CHECK_FALSE(fs::exists(m.own / "c"));
}

TEST_CASE("a secret is not laid out where a disk would have it", "[secrets]") {
  temp_folder disk;
  if (is_in_memory(disk.path())) {
    WARN("skipped: the folder of this test lies in memory");
    return;
  }
  const memory_folder folder{{disk.path()}, "secrets"};
  const auto made = folder.lay_out("i", {{"key", "value"}}, {});
  REQUIRE(std::holds_alternative<edge_error>(made));
  CHECK(std::get<edge_error>(made).message
        == "there is no file system of memory to lay secrets out in");
  CHECK(fs::is_empty(disk.path()));
}

TEST_CASE("nothing is removed by a link that stands in the folder's place",
          "[secrets]") {
  shared_memory m;
  temp_folder victim{"i/file", "x"};
  fs::create_directory_symlink(victim.path(), m.own);
  m.folder.clear("i");
  m.folder.clear_others({});
  CHECK(fs::exists(victim.path() / "i/file"));
  CHECK(std::holds_alternative<edge_error>(
      m.folder.lay_out("i", {{"key", "value"}}, {})));
}
