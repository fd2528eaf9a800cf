#include "actors/edge/disk/folder_watch.hpp"

#include "test/actors/edge/io/edge_fixture.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

/// A watch, and what it has told.
class heard_watch {
public:
  explicit heard_watch(size_t most = limits::folder::watched)
      : watch_{io_.core(), [this] { calls_.put(true); }, most} {}

  std::string follow(const std::vector<watched_folder>& folders) {
    return watch_.follow(folders);
  }

  /// Waits until something is told.
  bool heard() {
    return calls_.take();
  }

  /// By now: the loop has looked at its descriptors in between.
  size_t calls() {
    wire::settle(io_);
    wire::settle(io_);
    return calls_.size();
  }

private:
  wire::inbox<bool> calls_;
  io_thread io_;
  folder_watch watch_; // Ends before what it calls.
};

} // namespace

TEST_CASE("all that may make another build of a skill is told") {
  temp_folder folder;
  folder.write("echo/skill.json", "{}");
  folder.write("echo/bin/echo", "a");
  heard_watch watch;
  REQUIRE(
      watch.follow({{folder.path()}, {folder.path() / "echo", true}}).empty());
  const auto file = folder.path() / "echo/bin/echo";
  SECTION("a file is written to") {
    folder.append("echo/bin/echo", "b");
  }
  SECTION("a file is made") {
    folder.write("echo/bin/other", "");
  }
  SECTION("a file is removed") {
    fs::remove(file);
  }
  SECTION("a file is renamed") {
    fs::rename(file, folder.path() / "echo/bin/other");
  }
  SECTION("a file gets the right to execute") {
    fs::permissions(file, fs::perms::owner_all);
  }
  SECTION("a folder comes beside it") {
    fs::create_directory(folder.path() / "another");
  }
  SECTION("the folder goes") {
    fs::remove_all(folder.path() / "echo");
  }
  CHECK(watch.heard());
}

TEST_CASE("reading tells nothing, nor what is not watched any more") {
  temp_folder folder;
  folder.write("echo/bin/echo", "a");
  heard_watch watch;
  REQUIRE(watch.follow({{folder.path(), true}}).empty());
  SECTION("reading") {
    std::ifstream{folder / "echo/bin/echo"}.get();
    for (const auto& x : fs::recursive_directory_iterator{folder.path()})
      CHECK(fs::exists(x));
  }
  SECTION("what is not watched any more") {
    REQUIRE(watch.follow({}).empty());
    folder.append("echo/bin/echo", "b");
    fs::remove_all(folder.path() / "echo");
  }
  CHECK(watch.calls() == 0);
}

TEST_CASE("what is below a new folder is told once that is followed") {
  temp_folder folder;
  heard_watch watch;
  REQUIRE(watch.follow({{folder.path(), true}}).empty());
  folder.write("echo/bin/echo", "a");
  CHECK(watch.heard());
  REQUIRE(watch.follow({{folder.path(), true}}).empty());
  folder.append("echo/bin/echo", "b");
  CHECK(watch.heard());
}

TEST_CASE("the coming of a folder that is not there is told") {
  temp_folder folder;
  const auto late = folder.path() / "a/skills";
  heard_watch watch;
  REQUIRE(watch.follow({{late, true}}).empty());
  fs::create_directory(folder.path() / "a");
  CHECK(watch.heard());
  REQUIRE(watch.follow({{late, true}}).empty());
  fs::create_directory(late);
  CHECK(watch.heard());
  REQUIRE(watch.follow({{late, true}}).empty());
  folder.write("a/skills/echo", "x");
  CHECK(watch.heard());
}

TEST_CASE("of too many folders the first are watched, and that is said") {
  temp_folder folder;
  for (int i = 0; i < 5; ++i)
    fs::create_directory(folder.path() / std::to_string(i));
  heard_watch watch{3};
  const auto why = watch.follow({{folder.path(), true}});
  CHECK(why == "more than 3 folders");
  folder.write("new", "x");
  CHECK(watch.heard());
  fs::remove_all(folder.path() / "1");
  CHECK(watch.follow({{folder.path()}}).empty());
}

TEST_CASE("a link to a folder is watched where it leads, and no further") {
  temp_folder folder;
  temp_folder target;
  target.write("bin/echo", "a");
  fs::create_directory_symlink(target.path(), folder.path() / "echo");
  heard_watch watch;
  REQUIRE(watch.follow({{folder.path() / "echo", true}}).empty());
  target.append("bin/echo", "b");
  CHECK(watch.heard());
}
