#include "actors/instances/life/health_table.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace roscell;
using namespace std::chrono_literals;
using metrics = std::vector<stream_metrics>;

namespace {

/// A step with two inputs and one output, each of which is to have 5 Hz and a
/// frame in the last second, for whose breach there is a grace of 10 s.
struct stream_bench {
  stream_bench() {
    spec.life.health = {{5, 1}, {5, 1}, 10};
    spec.input = {end_of("/left"), end_of("/right")};
    spec.output = {end_of("/poses")};
  }

  static io_endpoint end_of(const char* topic) {
    return {"ros2", topic, "sensor_msgs/msg/Image", "", false};
  }

  /// Tells the same every second, from one second after the last time on.
  /// Returns whether the verdict has changed meanwhile.
  bool report(const metrics& reported, int seconds) {
    bool changed = false;
    for (int i = 0; i < seconds; ++i) {
      now += 1s;
      changed = table().hear(reported, now) || changed;
    }
    return changed;
  }

  health_table& table() {
    if (!made)
      made.emplace(spec, begin,
                   std::vector<std::string>{"it is fed by step 'camera'"},
                   before);
    return *made;
  }

  instance_health health() {
    return table().last().health;
  }

  std::string reason() {
    return table().last().reason;
  }

  instance_spec spec;
  health_verdict before;
  const health_table::time_point begin{1000s};
  health_table::time_point now = begin;
  std::optional<health_table> made;
};

const stream_metrics left{"input:0", 10, 0.1};
const stream_metrics right{"input:1", 10, 0.1};
const stream_metrics poses{"output:0", 10, 0.1};
const metrics fine{left, right, poses};

metrics with(const stream_metrics& x) {
  auto result = fine;
  for (auto& y : result)
    if (y.end == x.end)
      y = x;
  return result;
}

} // namespace

TEST_CASE("streams within their bounds are nobody's problem") {
  stream_bench b;
  CHECK_FALSE(b.report(fine, 60));
  CHECK(b.health() == instance_health::good);
  CHECK(b.reason().empty());
}

TEST_CASE("an input that is too slow for longer than the grace starves") {
  stream_bench b;
  const auto slow = with({"input:0", 2.13, 0.4});
  CHECK_FALSE(b.report(slow, 11));
  CHECK(b.health() == instance_health::good);
  CHECK(b.report(slow, 1));
  CHECK(b.health() == instance_health::starved);
  CHECK(b.reason()
        == "input '/left' comes at 2.13 Hz, at least 5 Hz are wanted; "
           "it is fed by step 'camera'");
}

TEST_CASE("what has been said once is not said again") {
  stream_bench b;
  CHECK(b.report(with({"input:0", 2, 0.4}), 12));
  CHECK_FALSE(b.report(with({"input:0", 1, 0.9}), 60));
  CHECK(b.reason().find("2 Hz") != std::string::npos);
}

TEST_CASE("one good value ends a breach") {
  stream_bench b;
  const auto slow = with({"input:0", 2, 0.4});
  for (int i = 0; i < 5; ++i) {
    CHECK_FALSE(b.report(slow, 11));
    CHECK_FALSE(b.report(fine, 1));
  }
  CHECK(b.health() == instance_health::good);
}

TEST_CASE("a stream is too old when its last frame is") {
  stream_bench b;
  b.report(with({"input:1", 10, 1.5}), 12);
  CHECK(b.health() == instance_health::starved);
  CHECK(b.reason()
        == "input '/right' has had no frame for more than 1.5 s, at most 1 s "
           "are wanted");
}

TEST_CASE(
    "a stream that never had a frame is as old as the instance is ready") {
  stream_bench b;
  b.spec.life.health.inputs = {0, 20};
  const auto silent = with({"input:0", 0, -1});
  CHECK_FALSE(b.report(silent, 31));
  CHECK(b.report(silent, 1));
  CHECK(b.health() == instance_health::starved);
  CHECK(b.reason().find("no frame for more than 32 s") != std::string::npos);
}

TEST_CASE("an output that stalls while every input is fine is unhealthy") {
  stream_bench b;
  const auto stalled = with({"output:0", 0, 7});
  CHECK_FALSE(b.report(stalled, 11));
  CHECK(b.report(stalled, 1));
  CHECK(b.health() == instance_health::unhealthy);
  CHECK(b.reason()
        == "output '/poses' has had no frame for more than 7 s, at most 1 s "
           "are wanted");
}

TEST_CASE("an output is not to blame for what its inputs lack") {
  stream_bench b;
  auto dry = with({"output:0", 0, 30});
  dry[0] = {"input:0", 0, 30};
  CHECK(b.report(dry, 60));
  CHECK(b.health() == instance_health::starved);
}

TEST_CASE("an output has its grace anew when its inputs have come back") {
  stream_bench b;
  auto dry = with({"output:0", 0, 30});
  dry[1] = {"input:1", 0, 30};
  b.report(dry, 60);
  const auto stalled = with({"output:0", 0, 30});
  CHECK(b.report(stalled, 1));
  CHECK(b.health() == instance_health::good);
  CHECK_FALSE(b.report(stalled, 9));
  CHECK(b.report(stalled, 2));
  CHECK(b.health() == instance_health::unhealthy);
}

TEST_CASE("an input that has failed a moment before its output is to blame") {
  stream_bench b;
  b.report(with({"output:0", 0, 2}), 1);
  auto dry = with({"output:0", 0, 30});
  dry[0] = {"input:0", 0, 30};
  CHECK(b.report(dry, 30));
  CHECK(b.health() == instance_health::starved);
}

TEST_CASE("who has been starved is so until every input is fine") {
  stream_bench b;
  b.report(with({"input:0", 0, 30}), 12);
  auto other = with({"input:1", 1, 0.5});
  CHECK_FALSE(b.report(other, 10));
  CHECK(b.health() == instance_health::starved);
  CHECK(b.report(fine, 1));
  CHECK(b.health() == instance_health::good);
  CHECK(b.reason().empty());
}

TEST_CASE("another input that breaks a bound is told of") {
  stream_bench b;
  b.report(with({"input:0", 0, 30}), 12);
  CHECK(b.report(with({"input:1", 0, 30}), 12));
  CHECK(b.reason().find("'/right'") != std::string::npos);
}

TEST_CASE("a grace does not run while nothing is told") {
  stream_bench b;
  const auto slow = with({"input:0", 2, 0.4});
  b.report(slow, 1);
  b.now += 15s;
  CHECK_FALSE(b.report(slow, 10));
  CHECK(b.report(slow, 2));
}

TEST_CASE("a pause that is hardly longer than the grace ends no breach") {
  stream_bench b;
  const auto slow = with({"input:0", 2, 0.4});
  b.report(slow, 1);
  b.now += 13s;
  CHECK(b.report(slow, 1));
}

TEST_CASE("streams without bounds, and those that nobody has, are not judged") {
  stream_bench b;
  b.spec.life.health.inputs = {};
  CHECK_FALSE(b.report(with({"input:0", 0, -1}), 60));
  auto odd = fine;
  odd.push_back({"output:7", 0, -1});
  odd.push_back({"input:0x", 0, -1});
  CHECK_FALSE(b.report(odd, 60));
  CHECK_FALSE(b.report({}, 60));
}

TEST_CASE("a stream of which no more is told is in no breach") {
  stream_bench b;
  b.report(with({"input:0", 0, 30}), 5);
  CHECK_FALSE(b.report({right, poses}, 60));
}

TEST_CASE("without a grace the first broken value but one counts") {
  stream_bench b;
  b.spec.life.health.grace_s = 0;
  const auto slow = with({"input:0", 2, 0.4});
  CHECK_FALSE(b.report(slow, 1));
  CHECK(b.report(slow, 1));
}

TEST_CASE("a node that was restarted knows what it has said before") {
  stream_bench b;
  b.before = {instance_health::starved, "input '/left' is late"};
  const auto slow = with({"input:0", 2, 0.4});
  CHECK_FALSE(b.report(slow, 5));
  CHECK(b.health() == instance_health::starved);
  CHECK(b.report(fine, 1));
  CHECK(b.health() == instance_health::good);
}

TEST_CASE("only a policy that asks for something has bounds") {
  CHECK_FALSE(has_bounds(health_policy{}));
  CHECK(has_bounds(health_policy{{0, 1}, {}, 10}));
  CHECK(has_bounds(health_policy{{}, {5, 0}, 10}));
}

namespace {

const server_sight::time_point at_start{1h};
const std::vector<std::string> both_ends{"a writer of /poses",
                                         "a reader of /image"};

} // namespace

TEST_CASE("what the server has not known for ten seconds is missed, until it "
          "knows it") {
  server_sight sight{false};
  CHECK_FALSE(sight.judge(at_start));
  sight.hear(both_ends, at_start);
  CHECK_FALSE(sight.judge(at_start + 9s));
  CHECK(sight.reason().empty());
  CHECK(sight.judge(at_start + 10s));
  CHECK(sight.reason()
        == "it is not known to its node's discovery server, which has not "
           "seen a writer of /poses, a reader of /image, so that nobody else "
           "hears of it; `roscell topics` and `roscell doctor` look for the "
           "cause");
  // It is said once, also while parts of it come and go.
  sight.hear({both_ends[0]}, at_start + 20s);
  CHECK_FALSE(sight.judge(at_start + 40s));
  sight.hear({}, at_start + 41s);
  CHECK(sight.judge(at_start + 41s));
  CHECK(sight.reason().empty());
}

TEST_CASE("a server that has begun anew has ten seconds to hear of its "
          "programs") {
  server_sight sight{false};
  sight.hear({}, at_start);
  CHECK_FALSE(sight.judge(at_start + 1h));
  sight.hear(both_ends, at_start + 1h);
  sight.hear({both_ends[0]}, at_start + 1h + 3s);
  CHECK_FALSE(sight.judge(at_start + 1h + 9s));
  sight.hear({}, at_start + 1h + 9s);
  CHECK_FALSE(sight.judge(at_start + 2h));
}

TEST_CASE("what was missed before the node began anew is so until it is "
          "known") {
  server_sight sight{true};
  CHECK_FALSE(sight.judge(at_start + 1h));
  sight.hear(both_ends, at_start + 1h);
  CHECK_FALSE(sight.judge(at_start + 1h));
  CHECK_FALSE(sight.judge(at_start + 2h));
  sight.hear({}, at_start + 2h);
  CHECK(sight.judge(at_start + 2h));
}
