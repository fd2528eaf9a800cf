#include "test/actors/edge/io/edge_fixture.hpp"

#include <memory>
#include <stdexcept>
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
