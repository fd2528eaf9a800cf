#include "actors/core/ros2_setting.hpp"
#include "actors/instances/container_supervisor.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/limits.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

struct reported_answer {
  std::string instance;
  int64_t number = 0;
  std::string problem;
};

/// A supervisor with one instance "i" that runs, whose node has a router.
struct requesting_node : virtual_time {
  explicit requesting_node(bool allowed = true) {
    config.context = context;
    config.node = "n";
    config.skills = std::make_shared<current_skills>(catalogue.skills);
    config.store = fake_store(system, store);
    config.make_runtime = [this](container_listener_actor) {
      return runtime_in_use = fake_runtime(system, runtime);
    };
    config.answer_request = [this](const std::string& instance, int64_t number,
                                   const std::string& problem) {
      answers.push_back({instance, number, problem});
      return parameter_delivery::written;
    };
    supervisor = roscell::spawn(system, context, container_supervisor, config);
    settle();
    auto spec = echo_spec(catalogue.hash, "i");
    let_ros2_set_parameters(spec, allowed);
    ask<instance_deployed>(supervisor, instance_deployment{spec});
    settle();
    say(instance_notified{"i", true, true});
  }

  ~requesting_node() {
    kill(supervisor);
    kill(runtime_in_use);
    kill(config.store);
    if (router)
      kill(router);
  }

  void say(const instance_notified& x) {
    caf::anon_send(supervisor, x);
    settle();
  }

  void want(int64_t number, const std::string& parameters) {
    instance_notified x;
    x.instance = "i";
    x.parameters_wanted = number;
    x.wanted_parameters = parameters;
    say(x);
  }

  /// @param text What it answers; empty: nothing.
  void use_router(const request_routed& reply, bool silent = false) {
    const auto made = system.spawn(
        [this, reply, silent](caf::event_based_actor* self) -> caf::behavior {
          return {[this, reply, silent, self](
                      const route_request& x) -> caf::result<request_routed> {
            asked.push_back(x);
            if (silent)
              return self->make_response_promise<request_routed>();
            return reply;
          }};
        });
    router = caf::actor_cast<request_router_actor>(made);
    caf::anon_send(supervisor, roscell::use_router{router});
    settle();
  }

  echo_catalogue catalogue;
  std::shared_ptr<runtime_script> runtime = std::make_shared<runtime_script>();
  std::shared_ptr<store_script> store = std::make_shared<store_script>();
  container_supervisor_config config;
  container_supervisor_actor supervisor;
  runtime_actor runtime_in_use;
  request_router_actor router;
  std::vector<route_request> asked;
  std::vector<reported_answer> answers;
};

const request_routed done{R"({"type":"parameters_changed"})", ""};

} // namespace

TEST_CASE("what a program asks for is asked of the cell as a user would",
          "[parameters]") {
  requesting_node node;
  node.use_router(done);
  node.want(7, R"({"gain": 2})");
  REQUIRE(node.asked.size() == 1);
  // As what somebody asks by himself it is noted who has.
  CHECK(node.asked[0].only.empty());
  CHECK(json::parse(node.asked[0].text)
        == json{{"type", "parameter_change"},
                {"instance", "i"},
                {"parameters", {{"gain", 2}}}});
  CHECK(node.asked[0].from.find("'i'") != std::string::npos);
  REQUIRE(node.answers.size() == 1);
  CHECK(node.answers[0].instance == "i");
  CHECK(node.answers[0].number == 7);
  CHECK(node.answers[0].problem.empty());
  // And it may ask again.
  node.want(8, R"({"gain": 3})");
  CHECK(node.asked.size() == 2);
}

TEST_CASE("a program hears why what it asks for is refused", "[parameters]") {
  requesting_node node;
  node.use_router(
      {R"({"type":"error","error":{"code":"conflict","message":"too loud",)"
       R"("hint":"whisper","where":"/parameters/gain"}})",
       "conflict"});
  node.want(7, R"({"gain": 2})");
  REQUIRE(node.answers.size() == 1);
  CHECK(node.answers[0].problem == "too loud (whisper)");
}

TEST_CASE("a request that the cell lets nobody have reaches no router",
          "[parameters]") {
  requesting_node node{false};
  node.use_router(done);
  node.want(7, R"({"gain": 2})");
  CHECK(node.asked.empty());
  REQUIRE(node.answers.size() == 1);
  CHECK(node.answers[0].problem
        == "its cell lets no client of ROS 2 set parameters");
}

TEST_CASE("a request that names nothing, and one while the node starts, are "
          "refused",
          "[parameters]") {
  requesting_node node;
  node.want(1, R"({"gain": 2})");
  node.use_router(done);
  int64_t number = 2;
  for (const std::string text : {"", "{}", "[]", "7", "{\"a\":", "{\"a\":1,}"})
    node.want(number++, text);
  CHECK(node.asked.empty());
  REQUIRE(node.answers.size() == 7);
  CHECK(node.answers[0].problem
        == "its node is still starting; try again in a while");
  for (size_t i = 1; i < node.answers.size(); ++i)
    CHECK(node.answers[i].problem == "no parameters are named");
}

TEST_CASE("one request of an instance is open at a time, and ends by itself",
          "[parameters]") {
  requesting_node node;
  node.use_router({}, true);
  node.want(7, R"({"gain": 2})");
  node.want(8, R"({"gain": 3})");
  CHECK(node.asked.size() == 1);
  REQUIRE(node.answers.size() == 1);
  CHECK(node.answers[0].number == 8);
  CHECK(node.answers[0].problem
        == "another change of its parameters is under way");
  // It is alive meanwhile.
  const auto half = limits::instance::parameter_request / 2 - 1s;
  for (int i = 0; i < 2; ++i) {
    node.pass(half);
    node.say(instance_notified{"i", true, true});
  }
  node.pass(2s - 1ms);
  CHECK(node.answers.size() == 1);
  node.pass(1ms);
  REQUIRE(node.answers.size() == 2);
  CHECK(node.answers[1].number == 7);
  CHECK_FALSE(node.answers[1].problem.empty());
  node.want(9, R"({"gain": 3})");
  CHECK(node.asked.size() == 2);
}

TEST_CASE("what a program asks for reaches its supervisor as it has said it",
          "[parameters]") {
  notification said;
  said.parameters_wanted = 7;
  said.wanted_parameters = "{}";
  const auto reported = status_notification("i", said, false);
  CHECK(reported.parameters_wanted == 7);
  CHECK(reported.wanted_parameters == "{}");
}

TEST_CASE("only a cell that is set up so lets ROS 2 set parameters",
          "[parameters]") {
  auto spec = echo_spec("hash", "i");
  CHECK_FALSE(lets_ros2_set_parameters(spec));
  let_ros2_set_parameters(spec, true);
  CHECK(lets_ros2_set_parameters(spec));
  // Whoever has put it there.
  let_ros2_set_parameters(spec, false);
  CHECK_FALSE(lets_ros2_set_parameters(spec));
  CHECK(spec.environment.empty());
}
