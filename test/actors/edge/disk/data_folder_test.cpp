#include "actors/edge/disk/data_folder.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <string>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("a folder is held by one at a time, and named is who holds it") {
  temp_folder folder;
  const auto data = folder.path() / "a" / "data";
  {
    const auto lock = value_of(directory_lock::take(data));
    const auto why = error_of(directory_lock::take(data));
    CHECK(why.code == error_code::conflict);
    CHECK(why.message.find("process " + std::to_string(::getpid()))
          != std::string::npos);
  }
  value_of(directory_lock::take(data));
}

TEST_CASE("a data directory is made for its owner only") {
  temp_folder folder;
  const auto data = folder.path() / "data";
  value_of(directory_lock::take(data));
  struct stat info {};
  REQUIRE(::stat(data.c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0700);
}

TEST_CASE("a lock file of anything does not confuse the message") {
  temp_folder folder{"lock", "\xFF\xFF no number"};
  const auto lock = value_of(directory_lock::take(folder.path()));
  folder.write("lock", std::string(100, '1'));
  CHECK(error_of(directory_lock::take(folder.path())).message
        == "the data directory '" + folder.path().string()
               + "' is in use by another node");
}

TEST_CASE("what is no folder cannot be held") {
  temp_folder folder;
  const auto file = folder.write("file", "");
  CHECK(error_of(directory_lock::take(file)).code == error_code::internal);
  CHECK(error_of(directory_lock::take(file / "below")).code
        == error_code::internal);
}

namespace fs = std::filesystem;

TEST_CASE("a file is put aside with what belongs to it") {
  temp_folder folder;
  const auto file = folder.write("state.db", "a");
  folder.write("state.db-wal", "b");
  const auto to = value_of(put_aside(file));
  CHECK(to == folder.path() / "state.db.aside-1");
  CHECK(fs::exists(to));
  CHECK(fs::exists(to.string() + "-wal"));
  CHECK_FALSE(fs::exists(file));
  CHECK_FALSE(fs::exists(file.string() + "-wal"));
}

TEST_CASE("what was put aside before stays") {
  temp_folder folder;
  const auto file = folder.write("state.db", "a");
  folder.write("state.db.aside-1", "old");
  CHECK(value_of(put_aside(file)) == folder.path() / "state.db.aside-2");
  CHECK(fs::file_size(folder.path() / "state.db.aside-1") == 3);
}

TEST_CASE("no file is nothing to put aside") {
  temp_folder folder;
  CHECK(value_of(put_aside(folder.path() / "state.db")).empty());
}
