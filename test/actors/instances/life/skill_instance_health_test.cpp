#include "actors/node/event_log.hpp"
#include "test/actors/fakes/instance_bench.hpp"

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// A skill that runs, has to have 5 Hz at its input and its output with a grace
/// of 10 s, and tells of both every second.
struct measured_skill : instance_bench {
  measured_skill() {
    context.events = config.context.events =
        roscell::spawn(system, context, event_log, event_log_setup{});
    auto& spec = config.row.spec;
    spec.input = {{"ros2", "/image", "sensor_msgs/msg/Image", "camera", false}};
    spec.output = {{"ros2", "/poses", "tf2_msgs/msg/TFMessage", "", false}};
    spec.life.restart = {};
    spec.life.health = {{5, 0}, {5, 0}, 10};
  }

  ~measured_skill() {
    kill(context.events);
  }

  /// Tells the rates of both ends, in Hz, so many times.
  void measure(double input_hz, double output_hz, int seconds) {
    for (int i = 0; i < seconds; ++i) {
      advance(1s);
      report({{"input:0", input_hz, 0.1}, {"output:0", output_hz, 0.1}});
    }
  }

  void report(std::vector<stream_metrics> streams) {
    instance_notified words;
    words.instance = "i";
    words.alive = true;
    words.streams = std::move(streams);
    caf::anon_send(instance, words);
    settle();
  }

  const instance_row& row() const {
    return reported->last();
  }

  /// What was recorded of health, oldest first.
  std::vector<std::string> published_events() {
    const auto kept = ask<kept_events>(context.events, kept_events_query{});
    settle();
    std::vector<std::string> result;
    for (const auto& x : (*kept)->value().events)
      if (x.what == "instance_starved" || x.what == "instance_unhealthy"
          || x.what == "instance_recovered")
        result.push_back(x.what);
    return result;
  }
};

} // namespace

TEST_CASE("a starved instance goes on, and says what should feed it") {
  measured_skill s;
  s.start_ready();
  s.measure(2, 0, 30);
  CHECK(s.row().state == instance_state::running);
  CHECK(s.row().health == instance_health::starved);
  CHECK(s.row().health_reason
        == "input '/image' comes at 2 Hz, at least 5 Hz are wanted; it is fed "
           "by step 'camera'");
  CHECK(s.runtime->stopped.empty());
  CHECK(s.published_events() == std::vector<std::string>{"instance_starved"});
}

TEST_CASE("an instance whose input comes again is good again") {
  measured_skill s;
  s.start_ready();
  s.measure(2, 0, 30);
  s.measure(10, 10, 1);
  CHECK(s.row().health == instance_health::good);
  CHECK(s.row().health_reason.empty());
  CHECK(s.published_events()
        == std::vector<std::string>{"instance_starved", "instance_recovered"});
}

TEST_CASE("an unhealthy instance is started again, and judged anew") {
  measured_skill s;
  s.start_ready();
  s.measure(10, 0, 12);
  CHECK(s.published_events() == std::vector<std::string>{"instance_unhealthy"});
  CHECK(s.runtime->stopped.size() == 1);
  CHECK(s.row().state == instance_state::backing_off);
  CHECK(s.row().reason
        == "it is unhealthy: output '/poses' goes at 0 Hz, at least 5 Hz are "
           "wanted");
  s.advance(2s);
  CHECK(s.runtime->started.size() == 2);
  s.ready();
  CHECK(s.row().state == instance_state::running);
  CHECK(s.row().health == instance_health::good);
  s.measure(10, 0, 11);
  CHECK(s.row().state == instance_state::running);
}

TEST_CASE("an instance without bounds is not judged") {
  measured_skill s;
  s.config.row.spec.life.health = {};
  s.start_ready();
  s.measure(0, 0, 60);
  CHECK(s.row().state == instance_state::running);
  CHECK(s.row().health == instance_health::good);
}

TEST_CASE("one that is to end, and is waited for, is not started again for its "
          "health") {
  measured_skill s;
  s.config.row.spec.life.safe_state = true;
  s.start_ready();
  caf::anon_send(s.instance, stop_instance{"asked to"});
  s.measure(10, 0, 30);
  CHECK(s.row().state == instance_state::running);
  CHECK(s.runtime->stopped.empty());
}

TEST_CASE("a skill's word on its safety is shown at once") {
  measured_skill s;
  s.start_ready();
  instance_notified words;
  words.instance = "i";
  for (const auto word : {safe_word::unsafe, safe_word::safe}) {
    words.safe = word;
    caf::anon_send(s.instance, words);
    s.settle();
    CHECK(s.row().safe == word);
  }
}
