#include "actors/edge/process/process_spawner.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// Only a failing test ever waits so long.
constexpr auto patience = 30s;

program shell(const std::string& script) {
  return {"/bin/sh", {"-c", script}, {{"GIVEN", "yes"}}};
}

int wait_for_code(const spawned_program& x) {
  pollfd waited{x.pidfd.get(), POLLIN, 0};
  REQUIRE(::poll(&waited, 1, 30'000) == 1);
  CHECK(has_ended(x.pidfd.get()));
  const auto code = reap(x.pidfd.get());
  REQUIRE(code);
  return *code;
}

} // namespace

TEST_CASE(
    "a program is started with the environment it is given and no other") {
  temp_folder folder;
  const auto file = (folder.path() / "env").string();
  const auto x = value_of(spawn_program(
      shell("/usr/bin/env >" + file + "; exec >&- 2>&-"), patience));
  CHECK(wait_for_code(x) == 0);
  const auto text = read_small_file(file, 10'000).value_or("");
  CHECK(text.find("GIVEN=yes") != std::string::npos);
  CHECK(text.find("HOME=") == std::string::npos);
}

TEST_CASE("a program inherits no descriptor and no blocked signal") {
  temp_folder folder;
  const unique_fd leak{::open("/dev/null", O_RDONLY)};
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const auto fds = (folder.path() / "fds").string();
  const auto status = (folder.path() / "status").string();
  auto started = spawn_program(shell("ls /proc/self/fd >" + fds
                                     + "; cat /proc/self/status >" + status
                                     + "; exec >&- 2>&-"),
                               patience);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  CHECK(wait_for_code(value_of(std::move(started))) == 0);
  // The third is the folder that `ls` reads.
  CHECK(read_small_file(fds, 1000) == "0\n1\n2\n3\n");
  const auto text = read_small_file(status, 10'000).value_or("");
  CHECK(text.find("SigBlk:\t0000000000000000") != std::string::npos);
}

TEST_CASE("a program that fails before it closes its output says why") {
  const auto why = error_of(
      spawn_program(shell("echo 'no such model' >&2; exit 1"), patience));
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message == "cannot start '/bin/sh': no such model");
}

TEST_CASE("a program that ends without a word has been started") {
  CHECK(wait_for_code(value_of(spawn_program(shell("exit 7"), patience))) == 7);
}

TEST_CASE("a program that says too much is cut") {
  const auto why = error_of(spawn_program(
      shell("head -c 100000 /dev/zero | tr '\\0' x; exit 1"), patience));
  CHECK(why.message.size() < 3000);
}

TEST_CASE("a program that does not start in time is killed") {
  CHECK(error_of(spawn_program(shell("sleep 60"), 50ms)).message
        == "cannot start '/bin/sh': it did not start in time");
}

TEST_CASE("a program that is not there cannot be started") {
  const auto why = error_of(spawn_program({"/no/such/program"}, patience));
  CHECK(why.message.find("No such file") != std::string::npos);
}

TEST_CASE("a process is known by its number and start time") {
  const auto x =
      value_of(spawn_program(shell("exec >&- 2>&-; sleep 60"), patience));
  const auto container = to_container(x.identity);
  const auto again = process_of(container);
  REQUIRE(again);
  CHECK(again->pid == x.identity.pid);
  CHECK(again->start_time == x.identity.start_time);
  CHECK(open_process(*again));
  // As the shell replaces itself by its last command, this is its argument.
  CHECK_FALSE(open_process(*again, "/other-instance"));
  CHECK_FALSE(open_process({again->pid, again->start_time + 1}));
  CHECK_FALSE(has_ended(x.pidfd.get()));
  ::pidfd_send_signal(x.pidfd.get(), SIGKILL, nullptr, 0);
  CHECK(wait_for_code(x) == 137);
  CHECK_FALSE(open_process(*again));
  CHECK_FALSE(reap(x.pidfd.get()));
}

TEST_CASE("only a number, a colon and a number name a process") {
  for (const auto* text :
       {"", ":", "1", "1:", ":1", "-1:5", "0:5", "1:-5", "1:5 ", "a:b",
        "1:99999999999999999999", "99999999999:1", "1:2:3"})
    CHECK_FALSE(process_of(text));
}

TEST_CASE("the records of a shim are read as they are written") {
  temp_folder folder;
  CHECK_FALSE(read_pid_record(folder.path()));
  CHECK_FALSE(read_exit_record(folder.path()));
  folder.write("pid", "12 345 13\n");
  const auto process = read_pid_record(folder.path());
  REQUIRE(process);
  CHECK(to_container(*process) == "12:345");
  // Those of earlier versions were files.
  std::filesystem::remove(folder.path() / "pid");
  std::filesystem::create_symlink("13 346 14", folder.path() / "pid");
  CHECK(to_container(*read_pid_record(folder.path())) == "13:346");
  std::filesystem::remove(folder.path() / "pid");
  const auto exit = [&](const std::string& text) {
    folder.write("exit", text);
    return read_exit_record(folder.path());
  };
  const auto ended = exit(R"({"code":3,"signal":null,"at_unix_ms":1})");
  REQUIRE(ended);
  CHECK(ended->exit_code == 3);
  CHECK_FALSE(ended->terminated);
  const auto killed = exit(R"({"code":null,"signal":9,"at_unix_ms":1})");
  REQUIRE(killed);
  CHECK(killed->exit_code == 137);
  const auto reported =
      exit(R"({"code":0,"signal":null,"at_unix_ms":1,"terminated":true})");
  REQUIRE(reported);
  CHECK(reported->exit_code == 0);
  CHECK(reported->terminated);
}

TEST_CASE("records of anything else are none") {
  temp_folder folder;
  for (const std::string text :
       {"", "12 345", "12 345 13 14", "x y z", "-1 2 3"}) {
    folder.write("pid", text);
    CHECK_FALSE(read_pid_record(folder.path()));
  }
  for (const std::string text :
       {"", "null", "[]", "{", R"({"code":256})", R"({"code":"0"})",
        R"({"signal":128})", R"({"code":-1,"signal":0})"}) {
    folder.write("exit", text);
    CHECK_FALSE(read_exit_record(folder.path()));
  }
  folder.write("exit", R"({"code":0})" + std::string(10'000, ' '));
  CHECK_FALSE(read_exit_record(folder.path()));
}

TEST_CASE("a program is run to its end, and what it says is bounded") {
  CHECK(value_of(run_program(shell("echo $GIVEN; echo err >&2"), patience, 100))
        == "yes\nerr\n");
  CHECK(value_of(run_program(shell("seq 10000"), patience, 100)).size() == 100);
}

TEST_CASE("a program that fails, or does not end, is a clear error") {
  const auto failed =
      error_of(run_program(shell("echo why; exit 3"), patience, 100));
  CHECK(failed.message.find("code 3: why") != std::string::npos);
  const auto late = error_of(run_program(shell("sleep 60"), 50ms, 100));
  CHECK(late.code == error_code::timeout);
  // It has closed its output, but has not ended.
  const auto silent =
      error_of(run_program(shell("exec >&- 2>&-; sleep 60"), 50ms, 100));
  CHECK(silent.code == error_code::timeout);
}

namespace {

/// A process that holds another one back from its end, as a disk does that
/// hangs: who is traced by it is reaped by it first. It lets go when it is
/// killed.
pid_t hold_back(const std::string& fifo, int ready) {
  const auto tracer = ::fork();
  if (tracer != 0)
    return tracer;
  // Only a test that fails waits so long.
  ::alarm(30);
  char text[16] = {};
  const int from = ::open(fifo.c_str(), O_RDONLY | O_CLOEXEC);
  const bool heard = ::read(from, text, sizeof text - 1) > 0;
  const char held =
      heard && ::ptrace(PTRACE_SEIZE, std::atoi(text), nullptr, nullptr) == 0;
  if (::write(ready, &held, 1) == 1)
    ::pause();
  ::_exit(0);
}

} // namespace

TEST_CASE("a program that not even force ends is waited for no longer") {
  temp_folder folder;
  const auto fifo = (folder.path() / "pid").string();
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  int ready[2];
  REQUIRE(::pipe2(ready, O_CLOEXEC) == 0);
  const unique_fd reading{ready[0]}, writing{ready[1]};
  const auto tracer = hold_back(fifo, writing.get());
  const auto begin = std::chrono::steady_clock::now();
  const auto late = error_of(run_program(
      shell("echo $$ > " + fifo + "; exec /usr/bin/tail -f /dev/null"), 500ms,
      100));
  const auto took = std::chrono::steady_clock::now() - begin;
  char held = 0;
  CHECK(::read(reading.get(), &held, 1) == 1);
  ::kill(tracer, SIGKILL);
  ::waitpid(tracer, nullptr, 0);
  // Not every host lets processes be traced.
  if (held == 0)
    return;
  CHECK(late.code == error_code::timeout);
  CHECK(took < 10s);
}
