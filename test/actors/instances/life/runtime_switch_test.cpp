#include "actors/instances/life/runtime_switch.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

namespace {

using namespace roscell;
using namespace roscell::test;

struct switch_test {
  switch_test() {
    runtime = spawn(time.system, time.context, runtime_switch, below[0],
                    below[1], ears);
  }

  ~switch_test() {
    time.kill(runtime);
    for (const auto& x : below)
      time.kill(x);
  }

  template <class Reply, class Request>
  void ask(const Request& what) {
    time.ask<Reply>(runtime, what);
    time.settle();
  }

  void start(const std::string& instance, const std::string& image) {
    start_container request;
    request.instance = instance;
    request.image = image;
    ask<container_started>(request);
  }

  virtual_time time;
  std::shared_ptr<runtime_script> programs = std::make_shared<runtime_script>();
  std::shared_ptr<runtime_script> actors = std::make_shared<runtime_script>();
  std::shared_ptr<reported_changes> reported =
      std::make_shared<reported_changes>();
  container_supervisor_actor supervisor =
      fake_supervisor(time.system, reported);
  container_listener_actor ears =
      caf::actor_cast<container_listener_actor>(supervisor);
  std::vector<runtime_actor> below{fake_runtime(time.system, programs),
                                   fake_runtime(time.system, actors)};
  runtime_actor runtime;
};

} // namespace

TEST_CASE_METHOD(switch_test, "what is asked of an instance goes to the "
                              "runtime that has started it") {
  start("program", "roscell/echo:1");
  start("actor", actor_image("move_to"));
  CHECK(programs->started.size() == 1);
  REQUIRE(actors->started.size() == 1);
  CHECK(actors->started[0].instance == "actor");
  for (const auto* instance : {"program", "actor"}) {
    ask<container_stopped>(stop_container{instance, {}, 0});
    log_query query;
    query.instance = instance;
    ask<log_excerpt>(query);
    caf::anon_send(runtime, hear_container{instance});
    time.settle();
    ask<container_removed>(remove_container{instance, {}});
  }
  for (const auto& script : {programs, actors}) {
    CHECK(script->stopped.size() == 1);
    CHECK(script->queries.size() == 1);
    CHECK(script->heard.size() == 1);
    CHECK(script->removed.size() == 1);
  }
}

TEST_CASE_METHOD(switch_test, "an actor of an earlier run is looked for among "
                              "actors, where it is not") {
  ask<container_adopted>(adopt_container{"old", "actor:7"});
  ask<container_adopted>(adopt_container{"old", "pid 7"});
  CHECK(actors->adopted.size() == 1);
  CHECK(programs->adopted.size() == 1);
}

TEST_CASE_METHOD(switch_test, "an instance that was an actor may be a program "
                              "the next time") {
  start("x", actor_image("move_to"));
  start("x", "roscell/echo:1");
  ask<container_stopped>(stop_container{"x", {}, 0});
  CHECK(programs->stopped.size() == 1);
  CHECK(actors->stopped.empty());
}
