#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/process/child_watch.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/eventfd.h>

#include <csignal>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace roscell::test::wire {

TEST_CASE("a task that throws is logged and the next one runs") {
  inbox<std::string> log;
  io_thread io{[&](const std::string& line) { log.put(line); }};
  io.post([] { throw std::runtime_error("broken task"); });
  io.post([] { throw 42; });
  settle(io);
  CHECK(log.take().find("broken task") != std::string::npos);
  CHECK(log.take().find("no exception") != std::string::npos);
}

TEST_CASE("a log that throws does not end the thread") {
  io_thread io{[](const std::string&) { throw std::runtime_error("full"); }};
  io.post([] { throw std::runtime_error("first"); });
  io.post([] { throw std::runtime_error("second"); });
  settle(io);
}

TEST_CASE("tasks run in the order in which they are posted") {
  inbox<int> seen;
  io_thread io;
  for (int i = 0; i < 100; ++i)
    io.post([&seen, i] { seen.put(i); });
  for (int i = 0; i < 100; ++i)
    CHECK(seen.take() == i);
}

TEST_CASE(
    "a task of another thread does not overtake one of the thread itself") {
  inbox<int> seen;
  io_thread io;
  io.post([&] {
    io.post([&] { seen.put(1); });
    std::thread{[&] { io.post([&] { seen.put(2); }); }}.join();
  });
  CHECK(seen.take() == 1);
  CHECK(seen.take() == 2);
}

TEST_CASE("after stop nothing runs and what waits is let go") {
  auto held = std::make_shared<int>(1);
  io_thread io;
  io.stop();
  io.post([held] { FAIL("ran after stop"); });
  io.stop();
  CHECK(held.use_count() == 1);
}

TEST_CASE("the thread can be stopped from one of its own tasks") {
  inbox<bool> stopped;
  auto io = std::make_shared<io_thread>();
  auto* raw = io.get();
  raw->post([io = std::move(io), &stopped]() mutable {
    io.reset();
    stopped.put(true);
  });
  CHECK(stopped.take());
}

} // namespace roscell::test::wire

using namespace roscell;
using namespace roscell::test;
using roscell::test::wire::inbox;
using namespace std::chrono_literals;

namespace {

void raise(const shared_fd& fd) {
  const uint64_t one = 1;
  REQUIRE(::write(fd->get(), &one, sizeof(one)) == sizeof(one));
}

uint64_t take(const shared_fd& fd) {
  uint64_t count = 0;
  [[maybe_unused]] const auto n = ::read(fd->get(), &count, sizeof(count));
  return count;
}

shared_fd counter() {
  return share(unique_fd{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)});
}

/// Runs all that was posted to the thread before.
void flush(io_thread& io) {
  inbox<int> done;
  io.post([&] { done.put(0); });
  done.take();
}

} // namespace

TEST_CASE("a watched descriptor calls back each time it can be read") {
  io_thread io;
  inbox<uint64_t> seen;
  const auto fd = counter();
  raise(fd);
  const fd_watch watch{io.core(), fd, [&] {
                         seen.put(take(fd));
                         return true;
                       }};
  CHECK(seen.take() == 1);
  raise(fd);
  CHECK(seen.take() == 1);
}

TEST_CASE("a watch that is over is silent and leaves the descriptor open") {
  io_thread io;
  inbox<uint64_t> seen;
  const auto fd = counter();
  SECTION("because the callback says so") {
    const fd_watch watch{io.core(), fd, [&] {
                           seen.put(take(fd));
                           return false;
                         }};
    raise(fd);
    CHECK(seen.take() == 1);
    raise(fd);
    flush(io);
    CHECK(seen.size() == 0);
  }
  SECTION("because it was dropped") {
    {
      const fd_watch watch{io.core(), fd, [&] {
                             seen.put(take(fd));
                             return true;
                           }};
    }
    flush(io);
    raise(fd);
    flush(io);
    CHECK(seen.size() == 0);
  }
  SECTION("because the thread has stopped") {
    const fd_watch watch{io.core(), fd, [&] {
                           seen.put(take(fd));
                           return true;
                         }};
    io.stop();
    raise(fd);
    CHECK(seen.size() == 0);
  }
  CHECK(take(fd) > 0);
}

TEST_CASE("a watch with a pause merges what comes meanwhile") {
  io_thread io;
  inbox<uint64_t> seen;
  const auto fd = counter();
  const fd_watch watch{io.core(), fd,
                       [&] {
                         seen.put(take(fd));
                         return true;
                       },
                       100ms};
  raise(fd);
  CHECK(seen.take() == 1);
  for (int i = 0; i < 10; ++i)
    raise(fd);
  CHECK(seen.take() == 10);
}

TEST_CASE("the last words of a program come before its end") {
  temp_folder folder;
  io_thread io;
  const auto path = notify_path(folder.path());
  const auto socket = share(value_of(open_notify_socket(path)));
  auto child = value_of(spawn_program(
      {"/bin/sh", {"-c", "exec >&- 2>&-; exec sleep 60"}, {}}, 30s));
  const auto pidfd = share(std::move(child.pidfd));
  inbox<std::string> seen;
  const child_watch watch{io.core(),
                          pidfd,
                          socket,
                          {[&](const notification& x) { seen.put(x.status); },
                           [&] { seen.put("end"); }}};
  REQUIRE(send_notification(path, "STATUS=first"));
  CHECK(seen.take() == "first");
  // The socket is not looked at for a moment now, but the end is.
  REQUIRE(send_notification(path, "STATUS=last"));
  ::pidfd_send_signal(pidfd->get(), SIGKILL, nullptr, 0);
  CHECK(seen.take() == "last");
  CHECK(seen.take() == "end");
  reap(pidfd->get());
}

TEST_CASE("a folder's watch sees files made, written and renamed") {
  temp_folder folder;
  io_thread io;
  inbox<int> seen;
  const auto watch =
      watch_folder(io.core(), folder.path(), [&] { seen.put(0); });
  flush(io);
  folder.write("a", "1");
  seen.take();
  std::filesystem::rename(folder.path() / "a", folder.path() / "b");
  seen.take();
}

TEST_CASE("watching a folder that is not there does nothing") {
  io_thread io;
  const auto watch = watch_folder(io.core(), "/no/such/folder", [] {});
  flush(io);
}
