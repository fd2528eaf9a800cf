#include "actors/edge/exec/child_channel.hpp"

#include <catch2/catch.hpp>

#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <future>
#include <mutex>
#include <string>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

/// A shell beside nothing, whose descriptor 3 is the lifeline as a shim's is.
struct shell_bench {
  explicit shell_bench(const std::string& script,
                       std::optional<terminal_size> size = {},
                       unique_fd instance = {}) {
    program what;
    what.path = "/bin/bash";
    what.arguments = {"-c", script};
    what.environment = {{"PATH", "/usr/bin:/bin"}};
    auto started = spawn_attached(what, size);
    REQUIRE(std::holds_alternative<attached_program>(started));
    exec_callbacks calls;
    calls.on_output = [this](bool of_errors, std::string bytes) {
      (of_errors ? errors : output) += bytes;
      if (reads_on)
        channel->read_on(of_errors);
    };
    calls.on_input_taken = [this] { taken.set_value(); };
    calls.on_end = [this](int code, std::string reason) {
      why = std::move(reason);
      end.set_value(code);
    };
    // The io thread must not find it half made.
    std::promise<void> made;
    io.post([&, ready = made.get_future().share()] { ready.wait(); });
    channel = open_child_channel(
        io.core(), std::move(std::get<attached_program>(started)),
        size.has_value(), std::move(instance), std::move(calls));
    made.set_value();
  }

  ~shell_bench() {
    channel.reset();
    io.stop();
  }

  int await_end() {
    auto future = end.get_future();
    REQUIRE(future.wait_for(30s) == std::future_status::ready);
    return future.get();
  }

  io_thread io;
  std::string output;
  std::string errors;
  std::string why;
  bool reads_on = true;
  std::promise<void> taken;
  std::promise<int> end;
  std::shared_ptr<exec_channel> channel;
};

} // namespace

TEST_CASE("a command's outputs stay apart, and its exit code is told") {
  shell_bench b{"echo out; echo err >&2; exit 7"};
  CHECK(b.await_end() == 7);
  CHECK(b.output == "out\n");
  CHECK(b.errors == "err\n");
  CHECK(b.why.empty());
}

TEST_CASE("a command gets its input to its end") {
  const std::string bytes{"some\0bytes", 10};
  shell_bench b{"cat; echo end"};
  b.channel->write(bytes, true);
  CHECK(b.await_end() == 0);
  CHECK(b.output == bytes + "end\n");
}

TEST_CASE("a command with a terminal has one, of that size") {
  shell_bench b{"tty -s && stty size", terminal_size{101, 17}};
  CHECK(b.await_end() == 0);
  CHECK(b.output == "17 101\r\n");
}

TEST_CASE("a terminal's bytes go both ways, and its end is ^D") {
  shell_bench b{"stty -echo; echo ready; cat", terminal_size{80, 24}};
  b.channel->write("word\n", true);
  CHECK(b.await_end() == 0);
  CHECK(b.output.find("word") != std::string::npos);
}

TEST_CASE("a command that is ended says why, and its lifeline is cut") {
  // It does as a shim does.
  shell_bench b{"read -u 3; exit 9"};
  b.channel->end("the test wants it");
  CHECK(b.await_end() == 9);
  CHECK(b.why == "the test wants it");
}

TEST_CASE("a command ends with its instance") {
  const auto instance = ::fork();
  if (instance == 0) {
    ::pause();
    ::_exit(0);
  }
  shell_bench b{"read -u 3; exit 9", {}, unique_fd{::pidfd_open(instance, 0)}};
  ::kill(instance, SIGKILL);
  CHECK(b.await_end() == 9);
  CHECK(b.why == "the instance has ended");
  ::waitpid(instance, nullptr, 0);
}

TEST_CASE("what holds a command's streams after its end is not waited for") {
  shell_bench b{"(exec 3<&-; exec sleep 100) & echo $!"};
  CHECK(b.await_end() == 0);
  ::kill(std::stoi(b.output), SIGKILL);
}
