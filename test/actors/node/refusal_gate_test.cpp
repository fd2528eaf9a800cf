#include "actors/node/limits.hpp"
#include "actors/node/refusal_gate.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell {

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
