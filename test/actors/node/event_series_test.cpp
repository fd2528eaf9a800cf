#include "actors/node/event_series.hpp"
#include "actors/node/limits.hpp"
#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell {

namespace {

event one(const std::string& what, const std::string& subject,
          uint64_t sequence = 1) {
  return {sequence, 1, what, subject, ""};
}

size_t kept(event_series& x, int times, const std::string& what,
            const std::string& subject,
            event_series::time_point now = time_zero) {
  size_t result = 0;
  for (int i = 0; i < times; ++i)
    result += x.keeps(one(what, subject), now) ? 1 : 0;
  return result;
}

constexpr auto window = limits::event::repetition_window;
constexpr auto most = limits::event::repetitions;

} // namespace

TEST_CASE("what happens again and again is kept some times, then counted") {
  event_series x;
  CHECK(kept(x, most, "instance_changed", "a") == most);
  CHECK_FALSE(x.next());
  CHECK(kept(x, 500, "instance_changed", "a") == 0);
  REQUIRE(x.next() == time_zero + window);
  CHECK(x.take_due(*x.next() - std::chrono::milliseconds{1}).empty());
  const auto due = x.take_due(*x.next());
  REQUIRE(due.size() == 1);
  CHECK(due[0].more == 500);
  CHECK(due[0].last.what == "instance_changed");
}

TEST_CASE("a series that goes on is told ever more rarely") {
  event_series x;
  auto now = time_zero;
  kept(x, most + 1, "instance_changed", "a", now);
  auto span = std::chrono::milliseconds{window};
  for (int i = 0; i < 10; ++i) {
    now += span;
    REQUIRE(x.take_due(now).size() == 1);
    span = std::min<std::chrono::milliseconds>(
        2 * span, limits::event::longest_repetition_window);
    CHECK(kept(x, 100, "instance_changed", "a", now) == 0);
    CHECK(x.next() == now + span);
  }
  CHECK(span == limits::event::longest_repetition_window);
}

TEST_CASE("a series that was quiet for a span is over") {
  event_series x;
  kept(x, most + 1, "instance_changed", "a");
  CHECK(x.take_due(time_zero + window).size() == 1);
  CHECK_FALSE(x.next());
  const auto later = time_zero + 3 * window;
  CHECK(kept(x, 2 * most, "instance_changed", "a", later) == most);
}

TEST_CASE("one series does not silence another, nor what people ask for") {
  event_series x;
  kept(x, 1000, "instance_changed", "a");
  CHECK(kept(x, 1, "instance_changed", "b") == 1);
  CHECK(kept(x, 1, "task_changed", "a") == 1);
  CHECK(kept(x, 1000, "request_received", "a") == 1000);
}

TEST_CASE("of each series that is counted the present is known") {
  event_series x;
  for (uint64_t i = 0; i < 2 * most; ++i)
    x.keeps(one("instance_changed", "a", i + 1), time_zero);
  kept(x, 3, "instance_changed", "b");
  REQUIRE(x.last_ones().size() == 1);
  CHECK(x.last_ones()[0].sequence == 2 * most);
  CHECK(x.take_all().size() == 1);
  CHECK(x.last_ones().empty());
}

TEST_CASE("ever new series do not grow without bound") {
  event_series x;
  for (size_t i = 0; i < 3 * limits::event::series; ++i)
    CHECK(x.keeps(one("node_joined", std::to_string(i)), time_zero));
  kept(x, 1000, "node_joined", "late");
  // What finds no place is kept one by one: nothing is lost.
  CHECK(x.take_all().size() <= limits::event::series);
}

namespace {

int reported(refusal_gate& x, int times, const std::string& what,
             const std::string& subject = "") {
  int result = 0;
  for (int i = 0; i < times; ++i)
    result += x.lets_through(what, subject, time_zero) ? 1 : 0;
  return result;
}

} // namespace

TEST_CASE("what is no refusal is always told") {
  refusal_gate x;
  CHECK(reported(x, 1000, "node_joined") == 1000);
  CHECK(reported(x, 100, "skill_refused") == 100);
  CHECK_FALSE(x.next());
}

TEST_CASE("of many refusals the first are told and the others counted") {
  refusal_gate x;
  CHECK(reported(x, 1300, "session_refused", "10.0.0.1:1") == 5);
  REQUIRE(x.next());
  CHECK(x.take_due(*x.next() - std::chrono::milliseconds{1}).empty());
  const auto due = x.take_due(*x.next());
  REQUIRE(due.size() == 1);
  CHECK(due[0].what == "session_refused");
  CHECK(due[0].more == 1295);
  CHECK_FALSE(x.next());
}

TEST_CASE("refusals of one kind do not silence those of another") {
  refusal_gate x;
  CHECK(reported(x, 100, "request_refused", "registration_switch") == 5);
  CHECK(reported(x, 1, "request_refused", "task_request") == 1);
  CHECK(reported(x, 1, "coordinator_ignored", "a") == 1);
}

TEST_CASE("after its span a kind is told again") {
  refusal_gate x;
  CHECK(reported(x, 5, "session_refused") == 5);
  CHECK_FALSE(x.next());
  CHECK(x.lets_through("session_refused", "",
                       time_zero + limits::event::refusal_window));
  CHECK(reported(x, 4, "session_refused") == 4);
}

} // namespace roscell
