#include "actors/instances/life/restart_delay.hpp"
#include "actors/instances/limits.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

const run_end crash{true, 5s};

} // namespace

TEST_CASE("the pauses double from the first to the longest") {
  restart_policy policy;
  policy.delay_s = 1;
  policy.max_delay_s = 5;
  const std::vector<std::chrono::milliseconds> wanted{1s, 2s, 4s, 5s, 5s};
  for (size_t i = 0; i < wanted.size(); ++i)
    CHECK(restart_delay(policy, crash, static_cast<int64_t>(i), 0)
          == wanted[i]);
  CHECK(restart_delay(policy, crash, 1'000'000, 0) == 5s);
}

TEST_CASE("jitter makes a pause longer by up to a tenth, never shorter") {
  CHECK(restart_delay({}, crash, 0, 0) == 1000ms);
  CHECK(restart_delay({}, crash, 0, 1) == 1100ms);
  CHECK(restart_delay({}, crash, 0, 7) == 1100ms);
}

TEST_CASE("what shall not pause at all pauses a moment after the first time") {
  restart_policy policy;
  policy.delay_s = policy.max_delay_s = 0;
  CHECK(restart_delay(policy, crash, 0, 0) == 0ms);
  CHECK(restart_delay(policy, crash, 1, 0) == limits::instance::least_pause);
}

TEST_CASE("which ends are followed by a start says the policy") {
  const run_end done{false, 5s};
  restart_policy policy;
  CHECK(restart_delay(policy, crash, 0, 0));
  CHECK_FALSE(restart_delay(policy, done, 0, 0));
  policy.policy = restart_when::always;
  CHECK(restart_delay(policy, done, 0, 0));
  policy.policy = restart_when::never;
  CHECK_FALSE(restart_delay(policy, crash, 0, 0));
}

TEST_CASE("attempts in a row are bounded, and a long run begins them anew") {
  restart_policy policy;
  policy.max_attempts = 3;
  CHECK(restart_delay(policy, crash, 2, 0));
  CHECK_FALSE(restart_delay(policy, crash, 3, 0));
  policy.reset_after_s = 10;
  instance_row row;
  row.attempts = 3;
  CHECK(attempts_before(policy, row, {true, 9s}) == 3);
  CHECK(attempts_before(policy, row, {true, 10s}) == 0);
  // One that was never ready has not run at all.
  policy.reset_after_s = 0;
  CHECK(attempts_before(policy, row, {true, 0s}) == 3);
}

TEST_CASE("a clock that jumps makes a pause neither endless nor negative") {
  restart_policy policy;
  policy.max_delay_s = 60;
  CHECK(rest_of_delay(policy, 10'000, 4'000) == 6s);
  CHECK(rest_of_delay(policy, 10'000, 900'000'000) == 0s);
  CHECK(rest_of_delay(policy, 900'000'000'000, 4'000) == 66s);
}

TEST_CASE("of earlier ends the last five are kept, the newest first") {
  instance_row row;
  for (int i = 0; i < 8; ++i)
    keep_end(row, {i, i, "end", ""});
  REQUIRE(row.ends.size() == limits::instance::kept_ends);
  CHECK(row.ends.front().unix_ms == 7);
  CHECK(row.ends.back().unix_ms == 3);
}

TEST_CASE("of a log the last five lines are kept, and no endless one") {
  CHECK(last_lines("") == "");
  CHECK(last_lines("\n\n") == "");
  CHECK(last_lines("one") == "one");
  CHECK(last_lines("1\n2\n3\n4\n5\n6\n7\n") == "3\n4\n5\n6\n7");
  CHECK(last_lines("\n1\n2\n") == "\n1\n2");
  CHECK(last_lines(std::string(100'000, 'x')).size()
        <= limits::instance::end_log_bytes);
}
