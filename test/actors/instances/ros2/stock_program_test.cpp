#include "actors/instances/life/skill_instance.hpp"
#include "actors/instances/limits.hpp"
#include "actors/instances/ros2/graph_watch.hpp"

#include "messages/failure.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <csignal>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

constexpr const char* descriptor = R"({
  "operation": "talk", "engine": "ros2_standalone",
  "ros2": {"package": "demo_nodes_cpp", "executable": "talker",
           "topics": {"chatter": "output"}},
  "input": {"data_types": ["std_msgs/msg/String"], "protocols": ["ros2"]},
  "output": {"data_types": ["std_msgs/msg/String"], "protocols": ["ros2"]},
  "models": [{"name": "plain", "deployments": [
    {"name": "cpu", "base_image": "ros:humble", "architectures": ["amd64"],
     "resources": {"cpu": 0.1, "memory_mib": 32, "disk_mib": 16}}]}]})";

/// One instance of a stock ROS 2 program, and the graph that shows it.
struct stock_bench : virtual_time {
  stock_bench() {
    folder.write("talk/skill.json", descriptor);
    const auto found = std::make_shared<const skill_catalogue>(
        skill_catalogue::scan({folder.path()}));
    REQUIRE(found->skills().size() == 1);
    config.skills = std::make_shared<current_skills>(found);
    graph->begin_service();
    watch = roscell::spawn(system, context, graph_watch, graph);
    config.context = context;
    config.supervisor = fake_supervisor(system, reported);
    config.runtime = fake_runtime(system, runtime);
    config.store = fake_store(system, store);
    config.graph = watch;
    config.row.spec = echo_spec(found->skills()[0].hash, "i");
    config.row.spec.operation = "talk";
    config.row.spec.output = {{"ros2", "/t/words", "std_msgs/msg/String"}};
  }

  ~stock_bench() {
    kill(config.supervisor);
    kill(config.runtime);
    kill(config.store);
    kill(watch);
  }

  void start() {
    instance = roscell::spawn(system, context, skill_instance, config);
    caf::anon_send(instance, start_instance{});
    settle();
  }

  void writer_comes(const std::string& program = "/i") {
    endpoint_guid writer{};
    writer[0] = 1;
    graph->name_participant({1}, program);
    graph->add(writer, {"rt/t/words", "std_msgs::msg::dds_::String_", true,
                        true, "volatile", ""});
    settle();
  }

  void writer_goes() {
    graph->remove_participant({1});
    settle();
  }

  instance_state state() const {
    return reported->last().state;
  }

  temp_folder folder;
  std::shared_ptr<ros_graph> graph = std::make_shared<ros_graph>();
  graph_watch_actor watch;
  std::shared_ptr<reported_changes> reported =
      std::make_shared<reported_changes>();
  std::shared_ptr<runtime_script> runtime = std::make_shared<runtime_script>();
  std::shared_ptr<store_script> store = std::make_shared<store_script>();
  skill_instance_config config;
  skill_instance_actor instance;
};

} // namespace

TEST_CASE_METHOD(stock_bench, "a stock program runs once the cell has seen its "
                              "endpoints, and needs no signs of life") {
  start();
  CHECK(state() == instance_state::starting);
  writer_comes();
  CHECK(state() == instance_state::running);
  advance(1h);
  CHECK(state() == instance_state::running);
}

TEST_CASE_METHOD(stock_bench, "a stock program is started by its own command "
                              "and asked to end as ROS 2 asks") {
  start();
  REQUIRE(runtime->started.size() == 1);
  const auto& request = runtime->started[0];
  CHECK(request.command.front() == "/bin/bash");
  CHECK(request.stop_signal == SIGINT);
  CHECK(request.environment.at("RMW_IMPLEMENTATION") == "rmw_fastrtps_cpp");
  CHECK(runtime->prepared.at(0).entry_point.empty());
}

TEST_CASE_METHOD(stock_bench, "a stock program that is never seen is ended, "
                              "saying what was waited for") {
  start();
  writer_comes("/another");
  advance(limits::instance::ready + 1s);
  CHECK(state() == instance_state::failed);
  CHECK(reported->last().reason.find("a writer of /t/words")
        != std::string::npos);
}

TEST_CASE_METHOD(stock_bench, "a stock program whose endpoints have gone is "
                              "ended, but not at once") {
  start();
  writer_comes();
  writer_goes();
  advance(limits::instance::watchdog / 2);
  CHECK(state() == instance_state::running);
  writer_comes();
  advance(1h);
  CHECK(state() == instance_state::running);
  writer_goes();
  advance(limits::instance::watchdog + 1s);
  CHECK(state() == instance_state::failed);
  CHECK(reported->last().reason.find("has not seen a writer of /t/words")
        != std::string::npos);
}

TEST_CASE_METHOD(stock_bench, "a stock program that is adopted is looked for "
                              "again") {
  config.adopt = true;
  config.row.state = instance_state::running;
  config.row.container = "c1";
  runtime->adoption = {true, "c1", -1};
  start();
  CHECK(state() == instance_state::running);
  advance(limits::instance::watchdog + 1s);
  CHECK(state() == instance_state::failed);
}

TEST_CASE_METHOD(stock_bench, "a step without what the program's topics stand "
                              "for fails before anything is started") {
  config.row.spec.output.clear();
  start();
  CHECK(state() == instance_state::failed);
  CHECK(runtime->started.empty());
  CHECK(reported->last().reason.find("stands for 'output")
        != std::string::npos);
}
