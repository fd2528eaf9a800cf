#include "actors/edge/limit_units.hpp"
#include "actors/instances/container_supervisor.hpp"
#include "actors/instances/limits.hpp"

#include "messages/failure.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

using words = std::vector<std::string>;

/// A real supervisor with real skill instances over a fake runtime and store.
struct supervisor_bench : virtual_time {
  supervisor_bench() {
    config.context = context;
    config.node = "n";
    config.skills = std::make_shared<current_skills>(catalogue.skills);
    config.store = fake_store(system, store);
    config.make_runtime = [this](container_listener_actor) {
      runtimes.push_back(fake_runtime(system, runtime));
      return runtimes.back();
    };
    listener = fake_listener(system, reported);
  }

  ~supervisor_bench() {
    // First, because it would replace a runtime that has ended.
    if (supervisor)
      kill(supervisor);
    for (const auto& x : runtimes)
      kill(x);
    kill(config.store);
    kill(listener);
  }

  void start() {
    supervisor = roscell::spawn(system, context, container_supervisor, config);
    caf::anon_send(supervisor, listen_to_instances{listener});
    settle();
  }

  template <class Message>
  void notify(const Message& message) {
    caf::anon_send(supervisor, message);
    settle();
  }

  template <class Reply, class Request>
  auto answer_to(const Request& request) {
    auto result = ask<Reply>(supervisor, request);
    settle();
    return result;
  }

  auto deploy(const std::string& instance, const std::string& task = "t") {
    return answer_to<instance_deployed>(
        instance_deployment{echo_spec(catalogue.hash, instance, task)});
  }

  auto remove(const std::string& task) {
    return answer_to<instances_removed>(instance_removal{task});
  }

  void say(const std::string& instance, const std::string& status = {}) {
    notify(instance_notified{instance, true, true, false, status, false});
  }

  /// Deploys an instance, which says that it is ready.
  void run(const std::string& instance, const std::string& task = "t") {
    deploy(instance, task);
    say(instance);
  }

  /// The same of one that is started again when it fails.
  void run_again_and_again(const std::string& instance) {
    auto spec = echo_spec(catalogue.hash, instance);
    spec.life.restart.policy = restart_when::on_failure;
    answer_to<instance_deployed>(instance_deployment{spec});
    say(instance);
  }

  void exit_of(const std::string& instance, const std::string& container,
               int code) {
    notify(container_exited{instance, container, code});
  }

  /// An instance that an earlier run of the node has left in "c0".
  instance_row left_running(const std::string& instance) {
    instance_row result;
    result.spec = echo_spec(catalogue.hash, instance);
    result.state = instance_state::running;
    result.container = "c0";
    runtime->adoption = {true, "c0", -1};
    return result;
  }

  std::vector<instance_row> rows(const instance_query& query = {}) {
    auto result = answer_to<instance_description>(query);
    REQUIRE(*result);
    return **result ? (*result)->value().instances
                    : std::vector<instance_row>{};
  }

  instance_row row(const std::string& instance) {
    const auto found = rows({instance, {}});
    REQUIRE(found.size() == 1);
    return found[0];
  }

  /// Ends the actor of the one live instance, as a defect in it would.
  void kill_instance_actor() {
    caf::anon_send_exit(runtime->instance,
                        caf::exit_reason::unhandled_exception);
    settle();
  }

  echo_catalogue catalogue;
  std::shared_ptr<reported_changes> reported =
      std::make_shared<reported_changes>();
  std::shared_ptr<runtime_script> runtime = std::make_shared<runtime_script>();
  std::shared_ptr<store_script> store = std::make_shared<store_script>();
  std::vector<runtime_actor> runtimes;
  container_supervisor_config config;
  container_supervisor_actor supervisor;
  instance_listener_actor listener;
};

struct started_bench : supervisor_bench {
  started_bench() {
    start();
  }
};

/// The error of an answer that must be one.
template <class T>
failure refusal(const T& answer) {
  REQUIRE(*answer);
  REQUIRE_FALSE(**answer);
  return to_failure((*answer)->error());
}

template <class T>
auto reply(const T& answer) {
  REQUIRE(*answer);
  REQUIRE(**answer);
  return (*answer)->value();
}

} // namespace

TEST_CASE("a deployment is answered once the instance is ready") {
  started_bench b;
  const auto answer = b.deploy("i");
  CHECK_FALSE(*answer);
  b.say("i");
  const auto row = reply(answer).instance;
  CHECK(row.state == instance_state::running);
  CHECK(row.node == "n");
  CHECK(row.container == "c1");
}

TEST_CASE("the same deployment again joins the wait and starts nothing") {
  started_bench b;
  const auto first = b.deploy("i");
  const auto second = b.deploy("i");
  CHECK_FALSE(*second);
  b.say("i");
  CHECK(reply(first) == reply(second));
  CHECK(reply(b.deploy("i")) == reply(first));
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("an instance id with another spec is a conflict") {
  started_bench b;
  b.run("i");
  CHECK(refusal(b.deploy("i", "other")).code == error_code::conflict);
  CHECK(b.row("i").spec.task == "t");
}

TEST_CASE("what the node cannot run is refused by name") {
  started_bench b;
  auto spec = echo_spec(b.catalogue.hash, "i");
  auto expected = error_code::internal;
  SECTION("a skill") {
    spec.skill = std::string(64, 'a');
    expected = error_code::unknown_operation;
  }
  SECTION("a model") {
    spec.model = "fancy";
    expected = error_code::unknown_model;
  }
  SECTION("a deployment") {
    spec.deployment = "gpu";
    expected = error_code::unknown_deployment;
  }
  SECTION("an id that is no file name") {
    spec.instance = GENERATE("../i", "", ".", "a/b", "i\n");
    expected = error_code::schema_violation;
  }
  const auto answer = b.answer_to<instance_deployed>(instance_deployment{spec});
  CHECK(refusal(answer).code == expected);
  CHECK(b.rows().empty());
  CHECK(b.store->records.empty());
}

TEST_CASE("a failed start is told with node, exit code and last lines") {
  started_bench b;
  const auto answer = b.deploy("i");
  b.exit_of("i", "c1", 127);
  const auto why = refusal(answer);
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("exit code 127") != std::string::npos);
  const auto details = json::parse(why.details);
  CHECK(details
        == json{{"instance", "i"},
                {"node", "n"},
                {"exit_code", 127},
                {"log_tail", "first line\nlast line\n"}});
}

TEST_CASE("a failed instance is started anew by the same deployment") {
  started_bench b;
  b.deploy("i");
  b.exit_of("i", "c1", 1);
  CHECK(b.row("i").state == instance_state::failed);
  const auto again = b.deploy("i");
  b.say("i");
  CHECK(reply(again).instance.container == "c2");
  CHECK(b.row("i").log_tail.empty());
}

TEST_CASE("an instance that has finished is not run twice") {
  started_bench b;
  b.run("i");
  b.exit_of("i", "c1", 0);
  CHECK(reply(b.deploy("i")).instance.state == instance_state::stopped);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("removing a task leaves nothing of its instances") {
  started_bench b;
  b.run("a", "t");
  b.run("b", "t");
  b.run("c", "u");
  CHECK(reply(b.remove("t")).instances == words{"a", "b"});
  CHECK(b.rows().size() == 1);
  CHECK(b.runtime->stopped.size() == 2);
  CHECK(b.runtime->removed.size() == 2);
  CHECK(b.store->states("a").back() == "-");
  CHECK(b.row("c").state == instance_state::running);
}

TEST_CASE("removing one instance leaves the others of its task") {
  started_bench b;
  b.run("a", "t");
  b.run("b", "t");
  const auto answer =
      b.answer_to<instances_removed>(instance_removal{"t", "a"});
  CHECK(reply(answer).instances == words{"a"});
  CHECK(b.row("b").state == instance_state::running);
}

TEST_CASE("removing an unknown task removes nothing and is no error") {
  started_bench b;
  CHECK(reply(b.remove("nothing")).instances.empty());
}

TEST_CASE("a removal during the start ends it and refuses the deployment") {
  started_bench b;
  b.runtime->silent = true;
  const auto deployment = b.deploy("i");
  const auto removal = b.remove("t");
  CHECK(reply(removal).instances == words{"i"});
  CHECK(refusal(deployment).code == error_code::conflict);
  CHECK(b.rows().empty());
}

TEST_CASE("removals of one task join, deployments wait until they are over") {
  started_bench b;
  b.run("i");
  b.runtime->stops_never = true;
  const auto first = b.remove("t");
  const auto second = b.remove("t");
  CHECK(refusal(b.deploy("i")).code == error_code::conflict);
  CHECK_FALSE(*first);
  // The program is given up after its grace and force, then killed.
  b.advance(20'100ms);
  CHECK(reply(first).instances == words{"i"});
  CHECK(reply(second).instances == words{"i"});
  CHECK(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->removed.size() == 1);
}

TEST_CASE("a removal that fails says so and can be repeated") {
  started_bench b;
  b.run("i");
  b.runtime->remove_error = fail(error_code::engine_failed, "disk broken");
  CHECK(refusal(b.remove("t")).message == "disk broken");
  CHECK(b.row("i").state == instance_state::stopped);
  b.runtime->remove_error = {};
  CHECK(reply(b.remove("t")).instances == words{"i"});
}

TEST_CASE("a killed skill instance loses neither container nor answer") {
  started_bench b;
  const auto answer = b.deploy("i");
  b.runtime->adoption = {true, "c1", -1};
  SECTION("while it starts") {
    b.kill_instance_actor();
    CHECK(b.runtime->adopted.size() == 1);
    b.say("i");
  }
  SECTION("while it runs") {
    b.say("i");
    b.kill_instance_actor();
    CHECK(b.runtime->adopted.at(0).container == "c1");
  }
  CHECK(reply(answer).instance.state == instance_state::running);
  CHECK(b.runtime->started.size() == 1);
  CHECK(b.runtime->stopped.empty());
  b.exit_of("i", "c1", 9);
  CHECK(b.row("i").state == instance_state::failed);
}

TEST_CASE("a killed skill instance does not lose a removal either") {
  started_bench b;
  b.run("i");
  b.runtime->stops_never = true;
  const auto removal = b.remove("t");
  b.runtime->stops_never = false;
  b.runtime->adoption = {true, "c1", -1};
  b.kill_instance_actor();
  CHECK(reply(removal).instances == words{"i"});
}

TEST_CASE("an actor that dies again and again takes its program along") {
  started_bench b;
  const auto answer = b.deploy("i");
  b.runtime->adoption = {true, "c1", -1};
  for (int i = 0; i < 6; ++i)
    b.kill_instance_actor();
  CHECK(refusal(answer).code == error_code::engine_failed);
  CHECK(b.row("i").reason == "its supervision has failed");
  CHECK(b.runtime->stopped.size() == 1);
  CHECK(b.reported->last().state == instance_state::failed);
}

TEST_CASE("a runtime that dies is spawned anew and adopts what runs") {
  started_bench b;
  b.run("i");
  b.runtime->adoption = {true, "c1", -1};
  caf::anon_send_exit(b.runtimes.at(0), caf::exit_reason::kill);
  b.settle();
  CHECK(b.runtimes.size() == 2);
  CHECK(b.runtime->adopted.size() == 1);
  CHECK(b.row("i").state == instance_state::running);
  CHECK(reply(b.remove("t")).instances == words{"i"});
}

TEST_CASE("instances of an earlier run are adopted at the start") {
  supervisor_bench b;
  const auto running = b.left_running("r");
  auto failed = running;
  failed.spec.instance = "f";
  failed.state = instance_state::failed;
  b.config.restored = {running, failed};
  b.start();
  CHECK(b.runtime->adopted.size() == 1);
  CHECK(b.row("r").state == instance_state::running);
  CHECK(b.row("f").state == instance_state::failed);
  CHECK(reply(b.remove("t")).instances == words{"f", "r"});
}

namespace {

/// A node at 10.0.0.9, and a program that was started when it was at 10.0.0.5,
/// where it knew a discovery server.
struct moved_bench : supervisor_bench {
  moved_bench() {
    auto moved = left_running("moved");
    moved.spec.environment = {{"ROS_DISCOVERY_SERVER", "10.0.0.5:11811"}};
    config.restored = {moved};
    config.address = "10.0.0.9";
    config.started_at = {{"moved", "10.0.0.5"}};
  }
};

} // namespace

TEST_CASE("programs of another address are started again at the present one") {
  moved_bench b;
  auto stayed = b.config.restored[0];
  stayed.spec.instance = "stayed";
  b.config.restored.push_back(stayed);
  b.config.started_at["stayed"] = "10.0.0.9";
  b.start();
  // Where it is to find the cell is not known yet, also if it is wanted.
  b.notify(contact_proven{1, {"moved", "stayed"}});
  CHECK(b.runtime->stopped.empty());
  for (int i = 0; i < 2; ++i) {
    b.notify(use_environment{{{"ROS_DISCOVERY_SERVER", "10.0.0.9:11811"}}});
    b.advance(1ms);
  }
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->stopped[0].instance == "moved");
  REQUIRE(b.row("moved").ends.size() == 1);
  CHECK(b.row("moved").ends[0].reason
        == "the address of this host has changed from 10.0.0.5 to 10.0.0.9");
  REQUIRE(b.runtime->started.size() == 1);
  CHECK(b.runtime->started[0].environment.at("ROS_DISCOVERY_SERVER")
        == "10.0.0.9:11811");
  CHECK(b.row("stayed").state == instance_state::running);
}

TEST_CASE("programs of a coordinator at another address are told its server "
          "there and no other") {
  moved_bench b;
  b.config.environment = {{"ROS_DISCOVERY_SERVER", "10.0.0.9:11812"}};
  std::vector<std::string> reported;
  b.config.write_environment_update =
      [&reported](const std::string&,
                  const std::map<std::string, std::string>& place) {
        reported.push_back(place.at("ROS_DISCOVERY_SERVER"));
        return true;
      };
  b.start();
  b.notify(contact_proven{1, {"moved"}});
  CHECK(reported == words{"10.0.0.9:11812"});
  CHECK(b.row("moved").state == instance_state::running);
  CHECK(b.runtime->stopped.empty());
}

TEST_CASE("programs that know no discovery server do not mind an address") {
  supervisor_bench b;
  b.config.restored = {b.left_running("r")};
  b.config.address = "10.0.0.9";
  b.config.started_at = {{"r", "10.0.0.5"}};
  b.start();
  b.notify(contact_proven{1, {"r"}});
  CHECK(b.runtime->stopped.empty());
}

TEST_CASE("the listener hears of each state once") {
  started_bench b;
  b.deploy("i");
  b.say("i", "loading");
  b.say("i", "12 frames/s");
  CHECK(b.reported->states()
        == words{"pending", "building", "starting", "running"});
  CHECK(b.row("i").status == "12 frames/s");
  b.say("i", "frames=12 dropped=1");
  CHECK(b.row("i").metrics.frames == 12);
  CHECK(b.row("i").metrics.dropped == 1);
  CHECK(b.reported->states()
        == words{"pending", "building", "starting", "running"});
}

TEST_CASE("the listener hears once that an input is silent, and of its end") {
  started_bench b;
  auto spec = echo_spec(b.catalogue.hash, "i", "t");
  spec.input = {{"ros2", "/a", "std_msgs/msg/String"}};
  b.answer_to<instance_deployed>(instance_deployment{spec});
  instance_notified said{"i", true, true, false, "frames=0", false};
  said.frames.resize(1);
  said.frames[0].end = "input:0";
  const auto say = [&](std::chrono::seconds pause) {
    for (auto passed = 0s; passed < pause; passed += 4s) {
      b.advance(4s);
      b.notify(said);
    }
  };
  say(4s);
  const auto begun = b.reported->states().size();
  say(24s);
  CHECK(b.reported->states().size() == begun);
  say(60s);
  CHECK(b.reported->states().size() == begun + 1);
  CHECK(b.row("i").metrics.streams.at(0).quiet_s >= 30);
  said.frames[0].frames = 1;
  say(60s);
  CHECK(b.reported->states().size() == begun + 2);
}

TEST_CASE("the log of an instance is the runtime's, of others there is none") {
  started_bench b;
  b.deploy("i");
  log_query query;
  query.instance = "i";
  const auto known = b.answer_to<log_excerpt>(query);
  query.instance = "../../etc";
  const auto unknown = b.answer_to<log_excerpt>(query);
  CHECK(reply(known).text == "first line\nlast line\n");
  CHECK(refusal(unknown).code == error_code::unknown_task);
}

namespace {

/// A history with one log of each instance that is asked for.
struct history_bench : supervisor_bench {
  history_bench() {
    const auto history = system.spawn([this]() -> caf::behavior {
      return {[this](const log_query& x) {
                asked.push_back(x);
                return log_excerpt{x.instance, "kept", 4, true};
              },
              [](const kept_logs_query& x) {
                kept_log log;
                log.instance = x.instance;
                log.node = "name-of-before";
                return kept_logs{{log}};
              }};
    });
    config.history = caf::actor_cast<node_history_actor>(history);
    start();
  }

  ~history_bench() {
    kill(config.history);
  }

  std::string text_of(const log_query& query) {
    return reply(answer_to<log_excerpt>(query)).text;
  }

  std::vector<log_query> asked;
};

} // namespace

TEST_CASE("a kept log is read where there is no other, or it is asked for") {
  history_bench b;
  b.deploy("i");
  log_query query;
  query.instance = "i";
  CHECK(b.text_of(query) == "first line\nlast line\n");
  CHECK(b.asked.empty());
  query.previous = true;
  CHECK(b.text_of(query) == "kept");
  query.previous = false;
  // Its row may outlive its log.
  b.runtime->log_error = fail(error_code::unknown_task, "there is none");
  CHECK(b.text_of(query) == "kept");
  query.instance = "gone";
  CHECK(b.text_of(query) == "kept");
  CHECK(b.asked.size() == 3);
  query.instance = "i";
  b.runtime->log_error = fail(error_code::conflict, "too many follow it");
  const auto refused = b.answer_to<log_excerpt>(query);
  CHECK(refusal(refused).code == error_code::conflict);
}

TEST_CASE("kept logs are those of the node by its present name") {
  history_bench b;
  const auto answer = b.answer_to<kept_logs>(kept_logs_query{"i", ""});
  REQUIRE(reply(answer).logs.size() == 1);
  CHECK(reply(answer).logs.front().node == "n");
}

TEST_CASE("the log of what is removed is kept with its end") {
  started_bench b;
  b.run("i");
  b.remove("t");
  REQUIRE(b.runtime->removed.size() == 1);
  REQUIRE(b.runtime->removed[0].about.size() == 1);
  const auto& about = b.runtime->removed[0].about.front();
  CHECK(about.instance == "i");
  CHECK(about.task == "t");
  CHECK(about.node == "n");
  CHECK(about.state == instance_state::stopped);
  CHECK(about.reason == "removed");
  CHECK(about.exit_code == b.runtime->stop_code);
  CHECK(about.started_unix_ms > 0);
  CHECK(about.ended_unix_ms >= about.started_unix_ms);
}

TEST_CASE("queries choose by task and by instance") {
  started_bench b;
  b.deploy("a", "t");
  b.deploy("b", "u");
  CHECK(b.rows().size() == 2);
  CHECK(b.rows({"", "u"}).at(0).spec.instance == "b");
  CHECK(b.rows({"", "none"}).empty());
  const auto unknown =
      b.answer_to<instance_description>(instance_query{"z", ""});
  CHECK(refusal(unknown).code == error_code::unknown_task);
}

TEST_CASE("live instances are bounded") {
  started_bench b;
  const auto live = limits::instance::most;
  for (size_t i = 0; i < live; ++i)
    b.deploy("i" + std::to_string(i));
  CHECK(refusal(b.deploy("one-more")).code == error_code::conflict);
}

TEST_CASE("what has ended stays known until the coordinator keeps it") {
  started_bench b;
  const auto kept = limits::instance::most_ended;
  std::vector<std::string> ended;
  for (size_t i = 0; i < kept + 8; ++i) {
    ended.push_back("i" + std::to_string(i));
    b.deploy(ended.back());
    b.exit_of(ended.back(), "c" + std::to_string(i + 1), 1);
  }
  // The logs of the oldest are gone, not what became of them.
  CHECK(b.runtime->removed.size() == 8);
  CHECK(b.rows().size() == kept + 8);
  CHECK(b.store->states("i0").back() == "failed");
  b.notify(ends_acknowledged{ended});
  CHECK(b.rows().size() == kept);
  CHECK(b.store->states("i0").back() == "-");
}

TEST_CASE("what nobody acknowledges is bounded, and so are its bytes") {
  supervisor_bench b;
  const auto kept = limits::instance::most_ended;
  size_t most = 0;
  size_t parameters = 0;
  SECTION("many") {
    // About 1 KiB each.
    most = limits::instance::most_unacknowledged_bytes / limits::kib;
  }
  SECTION("large") {
    parameters = 100'000;
    most = 2;
  }
  for (size_t i = 0; i < kept + 600; ++i) {
    instance_row row;
    row.spec = echo_spec(b.catalogue.hash, "i" + std::to_string(i));
    row.spec.parameters = "{\"x\": \"" + std::string(parameters, 'x') + "\"}";
    row.state = instance_state::stopped;
    row.since_unix_ms = static_cast<int64_t>(i);
    b.config.restored.push_back(row);
  }
  b.start();
  const auto left = b.rows();
  CHECK(left.size() <= kept + most);
  CHECK(left.size() > kept + most / 2);
  // The newest.
  CHECK(std::any_of(left.begin(), left.end(), [&](const auto& x) {
    return x.spec.instance == "i" + std::to_string(kept + 599);
  }));
}

TEST_CASE("an engine's problem is told of every live instance, and its end") {
  started_bench b;
  b.run("i");
  b.notify(runtime_problem_changed{"the engine is away"});
  CHECK(b.row("i").problem == "the engine is away");
  CHECK(b.row("i").state == instance_state::running);
  CHECK(b.reported->last().problem == "the engine is away");
  b.deploy("j");
  CHECK(b.row("j").problem == "the engine is away");
  b.notify(runtime_problem_changed{});
  CHECK(b.row("i").problem.empty());
  CHECK(b.row("j").problem.empty());
}

TEST_CASE("what an earlier run has left and no record knows is ended") {
  supervisor_bench b;
  b.config.strays = {"t-a-1", "../not an instance"};
  b.start();
  REQUIRE(b.runtime->removed.size() == 1);
  CHECK(b.runtime->removed[0].instance == "t-a-1");
  CHECK(b.runtime->removed[0].container.empty());
}

TEST_CASE_METHOD(started_bench, "what runs of an edited skill goes on as it "
                                "was, and nothing new of it is deployed") {
  run_again_and_again("i");
  auto nothing = std::make_shared<const skill_catalogue>();
  config.skills->set(nothing);
  CHECK(row("i").state == instance_state::running);
  if (GENERATE(false, true)) { // Also under another actor.
    runtime->adoption = {true, "c1", -1};
    kill_instance_actor();
    CHECK(row("i").state == instance_state::running);
  }
  // A new start of it asks for the build that it was.
  const auto look = runtime->prepared.at(0).look;
  exit_of("i", "c1", 3);
  advance(2s);
  REQUIRE(runtime->prepared.size() == 2);
  CHECK(runtime->prepared[1].skill == catalogue.hash);
  CHECK(runtime->prepared[1].look == look);
  CHECK(refusal(deploy("j")).code == error_code::unknown_operation);
}

TEST_CASE_METHOD(started_bench, "a skill whose folder has gone elsewhere is "
                                "started again from there") {
  run_again_and_again("i");
  const auto moved = catalogue.folder.path() / "moved";
  std::filesystem::rename(catalogue.folder.path() / "echo", moved);
  config.skills->set(std::make_shared<const skill_catalogue>(
      catalogue.skills->scan_again({catalogue.folder.path()}, true)));
  exit_of("i", "c1", 3);
  advance(2s);
  REQUIRE(runtime->prepared.size() == 2);
  CHECK(runtime->prepared[1].skill_dir == moved);
}
