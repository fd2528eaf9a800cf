#include "tools/roscell/service_signals.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

using namespace roscell::cli;

namespace {

/// A service manager: what is sent to its socket can be read.
class manager {
public:
  explicit manager(const std::string& name)
      : fd_{socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)}, name_{name} {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name.data(), name.size());
    auto size = sizeof(sa_family_t) + name.size();
    if (name.front() == '@')
      address.sun_path[0] = '\0';
    else
      ++size;
    REQUIRE(bind(fd_, reinterpret_cast<const sockaddr*>(&address),
                 static_cast<socklen_t>(size))
            == 0);
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }

  ~manager() {
    close(fd_);
    if (name_.front() != '@')
      unlink(name_.c_str());
    unsetenv("NOTIFY_SOCKET");
  }

  manager(const manager&) = delete;
  manager& operator=(const manager&) = delete;

  std::string heard() {
    std::array<char, 64> buffer{};
    const auto n = recv(fd_, buffer.data(), buffer.size(), 0);
    return n < 0 ? "" : std::string{buffer.data(), static_cast<size_t>(n)};
  }

private:
  int fd_;
  std::string name_;
};

} // namespace

TEST_CASE("a service manager hears of start and stop", "[tools]") {
  const auto unique = "roscell-test-" + std::to_string(getpid());
  for (const auto& name : {"/tmp/" + unique, "@" + unique}) {
    manager systemd{name};
    readiness node{-1};
    CHECK(systemd.heard().empty());
    node.ready();
    CHECK(systemd.heard() == "READY=1");
    node.stopping();
    CHECK(systemd.heard() == "STOPPING=1");
  }
}

TEST_CASE("a service manager does not wait for a node that waits", "[tools]") {
  manager systemd{"@roscell-test-" + std::to_string(getpid())};
  std::array<int, 2> ends{};
  REQUIRE(pipe2(ends.data(), O_NONBLOCK) == 0);
  readiness node{ends[1]};
  node.waiting("waits for eth0");
  CHECK(systemd.heard() == "READY=1\nSTATUS=waits for eth0");
  char nothing = 0;
  CHECK(read(ends[0], &nothing, 1) < 0);
  node.ready();
  CHECK(systemd.heard() == "READY=1\nSTATUS=");
  CHECK(read(ends[0], &nothing, 1) == 1);
  node.ready();
  CHECK(systemd.heard() == "READY=1");
  close(ends[0]);
}

TEST_CASE("no child can speak in the node's name", "[tools]") {
  setenv("NOTIFY_SOCKET", "/nowhere", 1);
  readiness node{-1};
  CHECK(std::getenv("NOTIFY_SOCKET") == nullptr);
  node.ready(); // Nobody there is no error.
}

TEST_CASE("the reader of the ready descriptor gets a line and its end",
          "[tools]") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  readiness node{ends[1]};
  node.ready();
  std::array<char, 64> buffer{};
  CHECK(read(ends[0], buffer.data(), buffer.size()) == 8);
  CHECK(std::string{buffer.data()} == "READY=1\n");
  CHECK(read(ends[0], buffer.data(), buffer.size()) == 0);
  close(ends[0]);
}

TEST_CASE("SIGHUP wakes who hears it, once for several, and ends no wait",
          "[tools]") {
  using cause = stop_signals::cause;
  std::vector<cause> woken;
  // What it blocks is this thread's.
  std::thread{[&] {
    stop_signals signals{hangups::heard};
    std::raise(SIGHUP);
    std::raise(SIGHUP);
    woken.push_back(signals.wait_for(std::chrono::milliseconds{1}));
    const auto soon = [] {
      return std::chrono::steady_clock::now() + std::chrono::milliseconds{1};
    };
    woken.push_back(signals.wait_with(-1, soon()));
    woken.push_back(signals.wait_with(-1, soon()));
    std::raise(SIGTERM);
    woken.push_back(signals.wait_with(-1, std::nullopt));
  }}.join();
  CHECK(woken
        == std::vector<cause>{cause::timeout, cause::hangup, cause::timeout,
                              cause::signal});
}
