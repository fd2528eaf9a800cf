#include "actors/core/answer_limits.hpp"
#include "actors/node/node_agent.hpp"

#include "test/fixture.hpp"

#include <algorithm>

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

/// A node agent between a fake supervisor and a fake probe.
struct agent_fixture {
  virtual_time time;
  std::vector<instance_row> instances;
  std::vector<int64_t> sessions;
  std::vector<std::string> containers;
  node_resources host;
  bool probe_is_mute = false;
  use_measured use;
  std::vector<measured_instance> measured;
  std::vector<caf::response_promise> unanswered;
  caf::actor supervisor;
  caf::actor probe;
  local_agent_actor agent;

  agent_fixture() {
    host.name = "whatever the probe says";
    host.architecture = "amd64";
    host.cpu = {4, 0.5};
    host.memory_mib = {1000, 200};
    host.disk_mib = {1000, 100};
    host.gpus = {{0, "", {800, 100}}, {1, "", {800, 0}}};
    host.devices = {"/dev/video0"};
    supervisor = time.system.spawn([this] { return be_supervisor(); });
    probe = time.system.spawn(
        [this](caf::event_based_actor* self) { return be_probe(self); });
    node_agent_config config;
    config.node = "arm";
    config.labels = {{"room", "hall"}};
    config.devices = {"/dev/video0", "/dev/can0"};
    config.cpu_floor = 0.25;
    config.secrets = std::make_shared<secret_names>();
    config.secrets->set({"key", "pass"});
    config.supervisor = caf::actor_cast<container_supervisor_actor>(supervisor);
    config.probe = caf::actor_cast<resource_probe_actor>(probe);
    agent = spawn(time.system, time.context, node_agent, config);
  }

  ~agent_fixture() {
    unanswered.clear();
    time.kill(agent);
    time.kill(supervisor);
    time.kill(probe);
  }

  caf::behavior be_supervisor() {
    return {
        [this](const instance_query&) {
          return instance_description{instances};
        },
        [](const instance_deployment& x) -> caf::result<instance_deployed> {
          if (x.spec.operation != "echo")
            return fail(error_code::unknown_operation, "no such skill");
          instance_row row;
          row.spec = x.spec;
          return instance_deployed{row};
        },
        [](const instance_removal& x) {
          return instances_removed{{x.task + "-1"}};
        },
        [](const log_query& x) {
          return log_excerpt{x.instance, "text", 4, true};
        },
        [](const kept_logs_query& x) {
          kept_log log;
          log.instance = x.instance;
          return kept_logs{{log}};
        },
    };
  }

  caf::behavior be_probe(caf::event_based_actor* self) {
    return {
        [this, self](const measure_host& x) -> caf::result<host_measured> {
          sessions = x.sessions;
          containers = x.containers;
          if (!probe_is_mute)
            return host_measured{host};
          unanswered.push_back(self->make_response_promise());
          return caf::delegated<host_measured>{};
        },
        [this, self](const measure_use& x) -> caf::result<use_measured> {
          measured = x.instances;
          if (!probe_is_mute)
            return use;
          unanswered.push_back(self->make_response_promise());
          return caf::delegated<use_measured>{};
        },
    };
  }

  void add_instance(const std::string& container, instance_state state,
                    double gpu_memory = -1, int gpu = -1) {
    instance_row row;
    row.container = container;
    row.state = state;
    row.spec.resources = {1, 100, 10, gpu_memory};
    row.spec.gpu = gpu;
    instances.push_back(row);
  }

  template <class Reply, class Message>
  caf::expected<Reply> ask(const Message& message) {
    auto reply = time.ask<Reply>(agent, message);
    time.settle();
    REQUIRE(*reply);
    return **reply;
  }

  node_resources report() {
    auto reply = ask<resource_report>(resource_query{});
    REQUIRE(reply);
    return reply->resources;
  }
};

} // namespace

TEST_CASE_METHOD(agent_fixture,
                 "A report is what the host has, under the node's own name",
                 "[node_agent]") {
  const auto node = report();
  CHECK(node.name == "arm");
  CHECK(node.labels == std::map<std::string, std::string>{{"room", "hall"}});
  CHECK(node.secrets == std::vector<std::string>{"key", "pass"});
  CHECK(node.devices == std::vector<std::string>{"/dev/video0", "/dev/can0"});
  CHECK(node.cpu.used == 0.5);
  CHECK(node.gpus.size() == 2);
}

TEST_CASE_METHOD(agent_fixture, "What live instances say is told when asked",
                 "[node_agent]") {
  add_instance("10:5", instance_state::running);
  instances.back().spec.instance = "t-a-1";
  instances.back().status = "frames=7";
  instances.back().metrics.frames = 7;
  add_instance("11:5", instance_state::failed);
  const auto reported = ask<figures_report>(figures_query{});
  REQUIRE(reported);
  REQUIRE(reported->instances.size() == 1);
  CHECK(reported->instances[0].instance == "t-a-1");
  CHECK(reported->instances[0].status == "frames=7");
  CHECK(reported->instances[0].metrics.frames == 7);
}

TEST_CASE_METHOD(agent_fixture,
                 "What live instances take of the host is read when asked",
                 "[node_agent]") {
  add_instance("10:5", instance_state::running);
  instances.back().spec.instance = "t-a-1";
  add_instance("", instance_state::pending);
  add_instance("11:5", instance_state::failed);
  use.instances = {{"t-a-1", {61.5, 64, 0.5, 12, 0}}, {"unknown", {}}};
  CHECK(measured.empty());
  const auto reported = ask<figures_report>(figures_query{});
  REQUIRE(reported);
  REQUIRE(measured.size() == 1);
  CHECK(measured[0].instance == "t-a-1");
  CHECK(measured[0].container == "10:5");
  REQUIRE(reported->instances.size() == 2);
  CHECK(reported->instances[0].metrics.use.memory_mib == 61.5);
  CHECK(reported->instances[0].metrics.use.memory_limit_mib == 64);
}

TEST_CASE_METHOD(agent_fixture,
                 "What skills say is told, whether the host can be read or not",
                 "[node_agent]") {
  add_instance("10:5", instance_state::running);
  instances.back().spec.instance = "t-a-1";
  instances.back().metrics.frames = 7;
  probe_is_mute = true;
  const auto reply = time.ask<figures_report>(agent, figures_query{});
  time.advance(limits::local::part);
  time.settle();
  REQUIRE(*reply);
  REQUIRE(**reply);
  CHECK((**reply)->instances.at(0).metrics.frames == 7);
}

TEST_CASE_METHOD(agent_fixture, "What live instances have reserved is in use",
                 "[node_agent]") {
  add_instance("10:5", instance_state::running);
  add_instance("", instance_state::pending);
  add_instance("11:5", instance_state::failed);
  add_instance("12:5", instance_state::stopped);
  add_instance("13:5", instance_state::stopping, 300, 1);
  const auto node = report();
  CHECK(node.cpu.used == Approx(0.5 + 3));
  CHECK(node.memory_mib.used == Approx(200 + 300));
  CHECK(node.disk_mib.used == Approx(100 + 30));
  CHECK(node.gpus[0].memory_mib.used == Approx(100));
  CHECK(node.gpus[1].memory_mib.used == Approx(300));
}

TEST_CASE_METHOD(agent_fixture,
                 "On unified memory GPU memory is in use in the node's pool",
                 "[node_agent]") {
  host.unified_memory = true;
  host.gpus = {{0, "", {}}};
  add_instance("10:5", instance_state::running, 300, 0);
  const auto node = report();
  CHECK(node.memory_mib.used == Approx(200 + 100 + 300));
  CHECK(node.gpus[0].memory_mib.used == 0);
}

TEST_CASE_METHOD(agent_fixture,
                 "The probe leaves out our live processes and containers",
                 "[node_agent]") {
  add_instance("10:5", instance_state::running);
  add_instance("11:5", instance_state::failed);
  add_instance("sha256:abc", instance_state::running);
  add_instance("77", instance_state::running);
  add_instance("sha256:def", instance_state::failed);
  add_instance("", instance_state::pending);
  report();
  CHECK(sessions == std::vector<int64_t>{10});
  CHECK(containers == std::vector<std::string>{"sha256:abc", "77"});
}

TEST_CASE_METHOD(agent_fixture,
                 "A probe that does not answer is an error after 5 seconds",
                 "[node_agent]") {
  probe_is_mute = true;
  auto reply = time.ask<resource_report>(agent, resource_query{});
  time.advance(4900ms);
  CHECK_FALSE(*reply);
  time.advance(200ms);
  REQUIRE(*reply);
  REQUIRE_FALSE(**reply);
  CHECK(to_failure((*reply)->error()).code == error_code::timeout);
}

TEST_CASE_METHOD(agent_fixture,
                 "Deployments, removals and logs are the supervisor's",
                 "[node_agent]") {
  instance_deployment request;
  request.spec.instance = "t-1";
  request.spec.operation = "echo";
  CHECK(ask<instance_deployed>(request)->instance.spec.instance == "t-1");
  request.spec.operation = "dance";
  const auto refused = ask<instance_deployed>(request);
  REQUIRE_FALSE(refused);
  CHECK(to_failure(refused.error()).code == error_code::unknown_operation);
  CHECK(ask<instances_removed>(instance_removal{"t", ""})->instances
        == std::vector<std::string>{"t-1"});
  log_query query;
  query.instance = "t-1";
  CHECK(ask<log_excerpt>(query)->text == "text");
  const auto kept = ask<kept_logs>(kept_logs_query{"t-1", ""});
  REQUIRE(kept->logs.size() == 1);
  CHECK(kept->logs.front().instance == "t-1");
}

namespace {

instance_spec wanted(const std::string& instance, double cores,
                     double gpu_memory = -1, int gpu = -1) {
  instance_spec spec;
  spec.instance = instance;
  spec.task = "t";
  spec.operation = "echo";
  spec.resources = {cores, 100, 10, gpu_memory};
  spec.gpu = gpu;
  return spec;
}

} // namespace

TEST_CASE_METHOD(agent_fixture, "Room that is kept is in use, and told by name",
                 "[node_agent]") {
  const auto reply = ask<instances_reserved>(
      instance_reservation{"t", {wanted("t-a-1", 2), wanted("t-b-1", 1)}});
  REQUIRE(reply);
  CHECK(reply->refused.empty());
  const auto now = ask<resource_report>(resource_query{});
  CHECK(now->resources.cpu.used == Approx(0.5 + 3));
  CHECK(now->reserved == std::vector<std::string>{"t-a-1", "t-b-1"});
}

TEST_CASE_METHOD(
    agent_fixture,
    "A node refuses what it has no room for and says what is short",
    "[node_agent]") {
  // The second fits alone, but not beside the first.
  const auto reply = ask<instances_reserved>(instance_reservation{
      "t", {wanted("t-a-1", 3), wanted("t-b-1", 1), wanted("t-c-1", 0.5)}});
  REQUIRE(reply->refused.size() == 1);
  CHECK(reply->refused[0].instance == "t-b-1");
  CHECK(reply->refused[0].reason == "needs 1.0 cores, 0.5 free: short by 0.5");
  CHECK(report().cpu.used == Approx(4));
}

TEST_CASE_METHOD(agent_fixture,
                 "What other programs use of the CPU is compressible down to "
                 "the floor, reservations are not",
                 "[node_agent]") {
  CHECK(report().cpu_compressible == 0);
  host.cpu.used = 3.75;
  add_instance("10:5", instance_state::running);
  const auto node = report();
  CHECK(node.cpu.used == Approx(4.75));
  CHECK(node.cpu_compressible == Approx(0.75));
}

TEST_CASE_METHOD(agent_fixture,
                 "A node judges a reservation by the reading that it was "
                 "placed with",
                 "[node_agent]") {
  host.cpu.used = 4;
  instance_reservation request{"t", {wanted("t-a-1", 1)}, false};
  CHECK(ask<instances_reserved>(request)->refused.size() == 1);
  request.cpu_floor = true;
  CHECK(ask<instances_reserved>(request)->refused.empty());
  // Room that is kept is a reservation, and never floored.
  auto other = wanted("u-a-1", 0.1);
  other.task = "u";
  CHECK(ask<instances_reserved>(instance_reservation{"u", {other}, true})
            ->refused.size()
        == 1);
}

TEST_CASE_METHOD(agent_fixture, "Two tasks never get the same room",
                 "[node_agent]") {
  auto first = time.ask<instances_reserved>(
      agent, instance_reservation{"t", {wanted("t-a-1", 3)}});
  auto other = wanted("u-a-1", 3);
  other.task = "u";
  auto second =
      time.ask<instances_reserved>(agent, instance_reservation{"u", {other}});
  time.settle();
  CHECK((*first)->value().refused.empty());
  CHECK((*second)->value().refused.size() == 1);
}

TEST_CASE_METHOD(agent_fixture, "A GPU that programs outside use is refused",
                 "[node_agent]") {
  host.gpus[0].memory_mib.used = 700;
  auto reply = ask<instances_reserved>(instance_reservation{
      "t",
      {wanted("t-a-1", 1, 200, 0), wanted("t-b-1", 1, 200, 1),
       wanted("t-c-1", 1, 200, 7)}});
  REQUIRE(reply->refused.size() == 2);
  CHECK(reply->refused[0].reason
        == "needs 200 MiB of GPU memory, 100 free: short by 100");
  CHECK(reply->refused[1].reason == "the node has no GPU 7");
}

TEST_CASE_METHOD(agent_fixture,
                 "Room is kept until the instance is there, and counts once",
                 "[node_agent]") {
  ask<instances_reserved>(instance_reservation{"t", {wanted("t-a-1", 2)}});
  add_instance("10:5", instance_state::starting);
  instances.back().spec = wanted("t-a-1", 2);
  CHECK(report().cpu.used == Approx(0.5 + 2));
  instances.back().state = instance_state::failed;
  CHECK(report().cpu.used == Approx(0.5));
}

TEST_CASE_METHOD(agent_fixture,
                 "Room is given up by a removal, a failure, a "
                 "repeated request, and after a minute",
                 "[node_agent]") {
  const instance_reservation request{"t", {wanted("t-a-1", 3)}};
  SECTION("removal") {
    ask<instances_reserved>(request);
    ask<instances_removed>(instance_removal{"t", ""});
  }
  SECTION("failure") {
    ask<instances_reserved>(request);
    auto spec = request.specs[0];
    spec.operation = "dance";
    CHECK_FALSE(ask<instance_deployed>(instance_deployment{spec}));
  }
  SECTION("repetition") {
    ask<instances_reserved>(request);
    CHECK(ask<instances_reserved>(request)->refused.empty());
    CHECK(report().cpu.used == Approx(3.5));
    ask<instances_reserved>(instance_reservation{"t", {}});
  }
  SECTION("time") {
    ask<instances_reserved>(request);
    time.advance(59s);
    CHECK(report().cpu.used == Approx(3.5));
    time.advance(2s);
  }
  CHECK(report().cpu.used == Approx(0.5));
}

} // namespace roscell::test
