#include "actors/edge/disk/put_aside.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

using namespace roscell;
using namespace roscell::test;

namespace fs = std::filesystem;

TEST_CASE("a file is put aside with what belongs to it") {
  own_folder folder;
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
  own_folder folder;
  const auto file = folder.write("state.db", "a");
  folder.write("state.db.aside-1", "old");
  CHECK(value_of(put_aside(file)) == folder.path() / "state.db.aside-2");
  CHECK(fs::file_size(folder.path() / "state.db.aside-1") == 3);
}

TEST_CASE("no file is nothing to put aside") {
  own_folder folder;
  CHECK(value_of(put_aside(folder.path() / "state.db")).empty());
}
