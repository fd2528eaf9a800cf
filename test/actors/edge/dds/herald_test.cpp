#include "actors/edge/dds/herald.hpp"

#include <catch2/catch.hpp>

#include <optional>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

using clock_type = std::chrono::steady_clock;

/// When it was said; the herald's thread adds to it.
class said_times {
public:
  void add() {
    std::lock_guard<std::mutex> lock{mutex_};
    times_.push_back(clock_type::now());
    changed_.notify_all();
  }

  /// The first `count` times, fewer if they do not come.
  std::vector<clock_type::time_point> wait_for(std::size_t count) {
    std::unique_lock<std::mutex> lock{mutex_};
    changed_.wait_for(lock, 20s, [&] { return times_.size() >= count; });
    return times_;
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<clock_type::time_point> times_;
};

} // namespace

TEST_CASE("a herald that was asked once speaks after each delay", "[herald]") {
  said_times said;
  herald x{{5ms, 20ms, 40ms}, 1ms, [&] { said.add(); }};
  auto begin = clock_type::now();
  x.start();
  x.ask();
  auto times = said.wait_for(3);
  x.stop();
  REQUIRE(times.size() == 3);
  CHECK(times[0] - begin >= 5ms);
  CHECK(times[1] - times[0] >= 20ms);
  CHECK(times[2] - times[1] >= 40ms);
}

TEST_CASE("a herald serves who asked before it started, and is idle after",
          "[herald]") {
  said_times said;
  herald x{{1ms}, 1ms, [&] { said.add(); }};
  x.ask();
  x.start();
  CHECK(said.wait_for(1).size() == 1);
  x.ask();
  CHECK(said.wait_for(2).size() == 2);
}

TEST_CASE("a herald that is asked during a later delay starts anew",
          "[herald]") {
  said_times said;
  herald x{{1ms, 1h}, 1ms, [&] { said.add(); }};
  x.start();
  for (std::size_t i = 1; i <= 3; ++i) {
    x.ask();
    REQUIRE(said.wait_for(i).size() == i);
  }
}

TEST_CASE("a herald keeps its pause however often it is asked", "[herald]") {
  said_times said;
  herald x{{0ms}, 30ms, [&] { said.add(); }};
  x.start();
  for (std::size_t i = 1; i <= 4; ++i) {
    x.ask();
    x.ask();
    said.wait_for(i);
  }
  auto times = said.wait_for(4);
  REQUIRE(times.size() >= 4);
  for (std::size_t i = 1; i < 4; ++i)
    CHECK(times[i] - times[i - 1] >= 30ms);
}

TEST_CASE("a herald stops whether it waits, was asked or never started",
          "[herald]") {
  said_times said;
  {
    herald never{{1h}, 1ms, [&] { said.add(); }};
    herald idle{{1h}, 1ms, [&] { said.add(); }};
    idle.start();
    herald asked{{1h}, 1ms, [&] { said.add(); }};
    asked.start();
    asked.ask();
    asked.stop();
    asked.stop();
  }
  CHECK(said.wait_for(0).empty());
}
