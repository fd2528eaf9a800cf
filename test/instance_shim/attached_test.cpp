#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>

using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

/// A socket that nobody takes connections of, as a node has it.
class lifeline {
public:
  lifeline() : fd_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path().copy(address.sun_path, sizeof(address.sun_path) - 1);
    const auto* where = reinterpret_cast<const sockaddr*>(&address);
    REQUIRE(::bind(fd_, where, sizeof(address)) == 0);
    REQUIRE(::listen(fd_, 1) == 0);
  }

  ~lifeline() {
    cut();
  }

  lifeline(const lifeline&) = delete;
  lifeline& operator=(const lifeline&) = delete;

  std::string path() const {
    return folder_ / "lifeline";
  }

  void cut() {
    if (fd_ >= 0)
      ::close(std::exchange(fd_, -1));
  }

private:
  temp_folder folder_;
  int fd_;
};

/// A script that somebody is attached to, by the pipes of a test's program.
struct attached_run {
  explicit attached_run(const std::vector<std::string>& command)
      : process(words(command), {{"PATH", "/usr/bin:/bin"}}) {
    // nop
  }

  std::vector<std::string> words(const std::vector<std::string>& command) {
    std::vector<std::string> result{shim,         "--attached", "pipes",
                                    "--lifeline", line.path(),  "--"};
    result.insert(result.end(), command.begin(), command.end());
    return result;
  }

  lifeline line;
  child_process process;
};

} // namespace

TEST_CASE("who is attached to a command has its output and its exit code") {
  attached_run x{{"sh", "-c", "echo out; echo err >&2; exit 7"}};
  CHECK(x.process.wait() == 7);
  CHECK(x.process.output() == "out\nerr\n");
  attached_run killed{{"sh", "-c", "kill -9 $$"}};
  CHECK(killed.process.wait() == 128 + SIGKILL);
}

TEST_CASE("who is attached to a command hears that it cannot be run") {
  attached_run x{{"no-such-program"}};
  CHECK(x.process.wait() == 127);
  CHECK_THAT(x.process.output(),
             Contains("roscell exec: cannot run 'no-such-program': No such "
                      "file"));
}

TEST_CASE("all of a command ends with its lifeline") {
  temp_folder folder;
  const auto file = folder / "pid";
  attached_run x{{"bash", "-c",
                  "setsid sleep 1000 & trap '' TERM HUP; echo $! > " + file
                      + "; mv " + file + " " + file + "s; exec sleep 1000"}};
  REQUIRE(wait_in_folder(folder / "",
                         [&] { return std::filesystem::exists(file + "s"); }));
  const auto left = std::stoi(content_of(file + "s"));
  x.line.cut();
  CHECK(x.process.wait() == 128 + SIGKILL);
  CHECK(wait_for_end(left));
}

TEST_CASE("what a command leaves behind ends with it") {
  attached_run x{{"bash", "-c", "setsid sleep 1000 < /dev/null & echo $!"}};
  CHECK(x.process.wait() == 0);
  CHECK(wait_for_end(std::stoi(x.process.output())));
}

TEST_CASE("no command is run without a lifeline") {
  child_process x{{shim, "--attached", "pipes", "--lifeline", "/no/such/socket",
                   "--", "touch", "/no/such/file"},
                  {}};
  CHECK(x.wait() == 1);
  CHECK_THAT(x.output(), Contains("cannot hold on to its /no/such/socket"));
  child_process records{
      {shim, "--attached", "pipes", "--exit", "/tmp/x", "--", "true"}, {}};
  CHECK(records.wait() == 2);
}
