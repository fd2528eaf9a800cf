#include "skills/engine/file/file_protocol.hpp"
#include "skills/engine/file/file_reading.hpp"

#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <sched.h>
#include <utility>

/// Files are followed also where the user has no inotify instance left.
using namespace roscell::engine;
using namespace roscell::test;

namespace {

constexpr int no_namespace = 77;

/// Runs `body` in a process whose user may have no inotify instance; the user
/// of this process is not touched. True if it was, or such a process cannot be
/// had here.
bool holds_without_inotify(const std::function<bool()>& body) {
  const auto child = ::fork();
  if (child == 0) {
    if (::unshare(CLONE_NEWUSER) != 0)
      ::_exit(no_namespace);
    {
      std::ofstream limit{"/proc/sys/user/max_inotify_instances"};
      if (!(limit << "0" << std::flush))
        ::_exit(no_namespace);
    }
    ::_exit(body() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_namespace) {
    WARN("no user namespace can be had here");
    return true;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// An input, and what it has said.
struct said_input {
  said_input(const std::string& path, const std::string& type)
      : input(make_file_input(
          {{"file", path, type},
           parameters::parse("{}"),
           [this](const std::string& line) { said += line + '\n'; }})) {}

  bool gives(std::size_t n, const std::string& text) {
    const auto found = input.sink().wait_for(n);
    return found && found->payload == text;
  }

  std::string said;
  running_input input;
};

} // namespace

TEST_CASE("a text file is followed without inotify, and that is said") {
  temp_folder folder{"in", "one\n"};
  CHECK(holds_without_inotify([&] {
    said_input x{folder / "in", "text/plain"};
    const bool begins = x.gives(0, "one");
    folder.append("in", "two\n");
    const bool grows = x.gives(1, "two");
    folder.write("new", "three\n");
    std::rename((folder / "new").c_str(), (folder / "in").c_str());
    return begins && grows && x.gives(2, "three")
           && x.said.find("fs.inotify.max_user_instances") != std::string::npos;
  }));
}

TEST_CASE("a file of another type is followed without inotify, once for each "
          "content") {
  temp_folder folder{"in", "one"};
  CHECK(holds_without_inotify([&] {
    said_input x{folder / "in", "image/png"};
    const bool begins = x.gives(0, "one");
    folder.write("in", "second");
    return begins && x.gives(1, "second");
  }));
}

TEST_CASE("a folder is followed without inotify") {
  temp_folder folder{"a", "one"};
  CHECK(holds_without_inotify([&] {
    said_input x{folder / "", "application/octet-stream"};
    const bool begins = x.gives(0, "one");
    folder.write("b", "two");
    return begins && x.gives(1, "two");
  }));
}

TEST_CASE("what is still being written is not taken where changes are looked "
          "for") {
  temp_folder folder{"a", "half"};
  CHECK(holds_without_inotify([&] {
    const inotify_watch changes;
    struct stat info {};
    if (!changes.looks() || ::stat((folder / "a").c_str(), &info) != 0)
      return false;
    info.st_mtim.tv_sec = std::time(nullptr) + 3600;
    const bool of_future = changes.may_be_unfinished(info);
    info.st_mtim.tv_sec = std::time(nullptr) - 3600;
    const bool of_past = changes.may_be_unfinished(info);
    std::timespec_get(&info.st_mtim, TIME_UTC);
    return changes.may_be_unfinished(info) && !of_future && !of_past;
  }));
}
