#include "actors/instances/ros2/graph_watch.hpp"
#include "actors/node/event_log.hpp"
#include "test/actors/fakes/instance_bench.hpp"

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// A skill of our engine that reads and writes a topic, and the graph that its
/// node's discovery server fills.
struct sighted_skill : instance_bench {
  sighted_skill() {
    context.events = config.context.events =
        roscell::spawn(system, context, event_log, event_log_setup{});
    graph->begin_service();
    config.graph = roscell::spawn(system, context, graph_watch, graph);
    auto& spec = config.row.spec;
    spec.input = {{"ros2", "/image", "sensor_msgs/msg/Image"}};
    spec.output = {{"ros2", "/poses", "tf2_msgs/msg/TFMessage"}};
    spec.life.restart = {};
  }

  ~sighted_skill() {
    kill(config.graph);
    kill(context.events);
  }

  /// It gives its signs of life for so long, and counts its frames.
  void lives_for(std::chrono::seconds span) {
    for (auto t = 0s; t < span; t += 2s) {
      advance(2s);
      instance_notified words;
      words.instance = "i";
      words.alive = true;
      words.frames = frames;
      caf::anon_send(instance, words);
      settle();
    }
  }

  void server_hears_of_it() {
    graph->name_participant({1}, "i");
    graph->add(end(1), {"rt/image", "sensor_msgs::msg::dds_::Image_", false,
                        true, "volatile", ""});
    graph->add(end(2), {"rt/poses", "tf2_msgs::msg::dds_::TFMessage_", true,
                        true, "volatile", ""});
    settle();
  }

  void server_drops_it() {
    graph->remove_participant({1});
    settle();
  }

  static endpoint_guid end(std::uint8_t number) {
    endpoint_guid result{};
    result[0] = 1;
    result[15] = number;
    return result;
  }

  const instance_row& row() const {
    return reported->last();
  }

  std::vector<std::string> published_events() {
    const auto kept = ask<kept_events>(context.events, kept_events_query{});
    settle();
    std::vector<std::string> result;
    for (const auto& x : (*kept)->value().events)
      if (x.what == "instance_starved" || x.what == "instance_recovered")
        result.push_back(x.what);
    return result;
  }

  std::vector<stream_count> frames = std::vector<stream_count>(1);
  std::shared_ptr<ros_graph> graph = std::make_shared<ros_graph>();
};

} // namespace

TEST_CASE_METHOD(sighted_skill, "a skill that its node's discovery server does "
                                "not know says so, and goes on") {
  start_ready();
  lives_for(10s);
  CHECK(row().health == instance_health::good);
  lives_for(4s);
  CHECK(row().state == instance_state::running);
  CHECK(row().health == instance_health::starved);
  CHECK(row().health_reason.find("it is not known to its node's discovery "
                                 "server, which has not seen a writer of "
                                 "/poses, a reader of /image")
        == 0);
  lives_for(60s);
  CHECK(published_events() == std::vector<std::string>{"instance_starved"});
  server_hears_of_it();
  CHECK(row().health == instance_health::good);
  CHECK(row().health_reason.empty());
  CHECK(published_events()
        == std::vector<std::string>{"instance_starved", "instance_recovered"});
  CHECK(runtime->stopped.empty());
}

TEST_CASE_METHOD(sighted_skill, "a skill that its node's discovery server has "
                                "dropped says so") {
  start_ready();
  server_hears_of_it();
  lives_for(1min);
  CHECK(row().health == instance_health::good);
  server_drops_it();
  lives_for(8s);
  CHECK(row().health == instance_health::good);
  lives_for(4s);
  CHECK(row().health == instance_health::starved);
}

TEST_CASE_METHOD(sighted_skill, "a node that restarts finds what its server "
                                "did not know as it was") {
  config.row.health = instance_health::starved;
  config.row.health_reason = "it is not known";
  adopt_as(instance_state::running, {true, "c1", -1});
  lives_for(2s);
  CHECK(row().health == instance_health::starved);
  server_hears_of_it();
  CHECK(row().health == instance_health::good);
  CHECK(published_events() == std::vector<std::string>{"instance_recovered"});
}

TEST_CASE_METHOD(sighted_skill, "a program that is started again is judged "
                                "anew") {
  start_ready();
  lives_for(14s);
  exits(3);
  CHECK(row().health == instance_health::good);
  advance(2s);
  ready();
  lives_for(8s);
  CHECK(row().state == instance_state::running);
  CHECK(row().health == instance_health::good);
  lives_for(6s);
  CHECK(row().health == instance_health::starved);
}

TEST_CASE_METHOD(sighted_skill, "a skill is not missed where nobody can know") {
  SECTION("its node has no server") {
    graph->end_service();
  }
  SECTION("it is not of our engine") {
    frames.clear();
  }
  SECTION("it has no topics") {
    config.row.spec.input.clear();
    config.row.spec.output.clear();
  }
  start_ready();
  lives_for(1min);
  CHECK(row().health == instance_health::good);
}

TEST_CASE_METHOD(sighted_skill, "why nobody knows it counts more than what its "
                                "input lacks, and less than its output") {
  config.row.spec.life.health = {{5, 0}, {5, 0}, 10};
  start_ready();
  const auto measure = [&](double input_hz, double output_hz) {
    instance_notified words;
    words.instance = "i";
    words.alive = true;
    words.frames = frames;
    words.streams = {{"input:0", input_hz, 0.1}, {"output:0", output_hz, 0.1}};
    for (int i = 0; i < 30; ++i) {
      advance(1s);
      caf::anon_send(instance, words);
      settle();
    }
  };
  SECTION("input") {
    measure(0, 0);
    CHECK(row().health == instance_health::starved);
    CHECK(row().health_reason.find("it is not known") == 0);
    server_hears_of_it();
    CHECK(row().health == instance_health::starved);
    CHECK(row().health_reason.find("input '/image' comes at 0 Hz") == 0);
  }
  SECTION("output") {
    measure(10, 0);
    CHECK(runtime->stopped.size() == 1);
  }
}
