#include "actors/edge/disk/trusted_path.hpp"

#include "actors/edge/disk/directory_lock.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

namespace fs = std::filesystem;

constexpr uid_t unauthenticated_peer = 4711;

void set_mode(const fs::path& path, mode_t mode) {
  REQUIRE(::chmod(path.c_str(), mode) == 0);
}

/// Only root can give files away.
bool give_away(const fs::path& path) {
  return ::lchown(path.c_str(), unauthenticated_peer, unauthenticated_peer)
         == 0;
}

fs::path make_folder(const fs::path& path, mode_t mode = 0755) {
  REQUIRE(::mkdir(path.c_str(), mode) == 0);
  set_mode(path, mode);
  return path;
}

} // namespace

TEST_CASE("what only this user and root may change is nobody else's") {
  own_folder folder;
  const auto file = folder.write("file", "x");
  set_mode(file, 0644);
  CHECK(who_may_change(file).empty());
  CHECK(who_may_replace(file).empty());
  CHECK(who_may_change("/").empty());
  CHECK(who_may_change(folder.path() / "none").empty());
}

TEST_CASE("what others may write to is told with who they are") {
  own_folder folder;
  const auto file = folder.write("file", "x");
  set_mode(file, 0664);
  CHECK(who_may_change(file) == "its group may write to it");
  set_mode(file, 0666);
  CHECK(who_may_change(file) == "everybody may write to it");
  // A sticky folder keeps files, but lets in new ones.
  CHECK(who_may_change(make_folder(folder.path() / "tmp", 01777))
        == "everybody may write to it");
  if (!give_away(file))
    return;
  set_mode(file, 0600);
  CHECK(who_may_change(file) == "it belongs to user 4711");
}

TEST_CASE("a folder on the way may let others in only while it is sticky") {
  own_folder folder;
  const auto shared = make_folder(folder.path() / "shared", 01777);
  const auto data = make_folder(shared / "data", 0700);
  CHECK(who_may_replace(data).empty());
  CHECK(who_may_replace(data.string() + "/").empty());
  set_mode(shared, 0777);
  CHECK(who_may_replace(data).find("everybody may write into '") == 0);
  set_mode(shared, 0755);
  if (!give_away(shared))
    return;
  CHECK(who_may_replace(data).find("on the way belongs to user 4711")
        != std::string::npos);
}

TEST_CASE("a link that others have made leads nowhere") {
  own_folder folder;
  const auto data = make_folder(folder.path() / "data", 0700);
  const auto link = folder.path() / "link";
  fs::create_symlink(data, link);
  CHECK(who_may_replace(link).empty());
  if (!give_away(link))
    return;
  CHECK(who_may_replace(link).find("link' on the way belongs to user 4711")
        != std::string::npos);
  CHECK_FALSE(who_may_replace(link / "below").empty());
}

TEST_CASE("a data directory into which others may put something is not taken, "
          "and nothing is written there") {
  own_folder folder;
  const auto data = make_folder(folder.path() / "data", 0700);
  fs::create_symlink(folder.write("victim", "precious"), data / "lock");
  SECTION("everybody may") {
    set_mode(data, 0777);
  }
  SECTION("everybody may, though it is sticky") {
    set_mode(data, 01777);
  }
  SECTION("it is somebody else's") {
    if (!give_away(data))
      return;
  }
  const auto why = error_of(directory_lock::take(data));
  CHECK(why.code == error_code::unauthorized);
  CHECK(why.message.find("the data directory '" + data.string()
                         + "' is not taken")
        == 0);
  CHECK(why.hint.find("--data-dir") != std::string::npos);
  CHECK(fs::file_size(folder.path() / "victim") == 8);
}
