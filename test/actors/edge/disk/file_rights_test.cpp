#include "actors/edge/disk/data_folder.hpp"
#include "actors/edge/disk/file_rights.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
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
  temp_folder folder;
  const auto file = folder.write("file", "x");
  set_mode(file, 0644);
  CHECK(who_may_change(file).empty());
  CHECK(who_may_replace(file).empty());
  CHECK(who_may_change("/").empty());
  CHECK(who_may_change(folder.path() / "none").empty());
}

TEST_CASE("what others may write to is told with who they are") {
  temp_folder folder;
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
  temp_folder folder;
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
  temp_folder folder;
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
  temp_folder folder;
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

namespace {

constexpr uid_t guest = 4712;

/// Whether it succeeds for a program of that user.
bool works_as(uid_t user, const std::function<bool()>& what) {
  const auto child = ::fork();
  if (child == 0)
    ::_exit(::setgid(user) == 0 && ::setuid(user) == 0 && what() ? 0 : 1);
  int status = -1;
  ::waitpid(child, &status, 0);
  return status == 0;
}

mode_t others_of(const std::string& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status.st_mode & 0007;
}

} // namespace

TEST_CASE("one more user may write a file, and nobody else", "[access]") {
  temp_folder folder;
  const auto file = folder.write("file", "x");
  ::chmod(file.c_str(), 0600);
  ::chmod(folder.path().c_str(), 0700);
  if (!let_user(folder.path(), guest, access_right::pass)) {
    WARN("this file system keeps no access control lists");
    return;
  }
  REQUIRE(let_user(file, guest, access_right::read_and_write));
  CHECK(others_of(file) == 0);
  if (::geteuid() != 0)
    return;
  const auto can_open = [file] { return ::access(file.c_str(), W_OK) == 0; };
  const auto can_list = [path = folder.path()] {
    return ::access(path.c_str(), R_OK) == 0;
  };
  CHECK(works_as(guest, can_open));
  CHECK_FALSE(works_as(guest, can_list));
  CHECK_FALSE(works_as(guest + 1, can_open));
  // Once more changes nothing, and another user is added.
  REQUIRE(let_user(file, guest, access_right::read_and_write));
  REQUIRE(let_user(folder.path(), guest + 1, access_right::pass));
  REQUIRE(let_user(file, guest + 1, access_right::read_and_write));
  CHECK(works_as(guest, can_open));
  CHECK(works_as(guest + 1, can_open));
}

TEST_CASE("a file that is not there lets nobody in", "[access]") {
  temp_folder folder;
  CHECK_FALSE(let_user(folder.path() / "none", guest, access_right::pass));
}
