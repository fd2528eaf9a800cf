#include "actors/edge/disk/access_list.hpp"

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
  own_folder folder;
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
  own_folder folder;
  CHECK_FALSE(let_user(folder.path() / "none", guest, access_right::pass));
}
