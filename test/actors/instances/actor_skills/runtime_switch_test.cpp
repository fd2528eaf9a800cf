#include "actors/instances/actor_skills/runtime_switch.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

namespace {

using namespace roscell;
using namespace roscell::test;

struct switch_test {
  switch_test() {
    runtime = spawn(time.system, time.context, runtime_switch,
                    fake_runtime(time.system, programs),
                    fake_runtime(time.system, actors), ears);
  }

  void start(const std::string& instance, const std::string& image) {
    start_container wish;
    wish.instance = instance;
    wish.image = image;
    time.ask<container_started>(runtime, wish);
  }

  virtual_time time;
  std::shared_ptr<runtime_script> programs = std::make_shared<runtime_script>();
  std::shared_ptr<runtime_script> actors = std::make_shared<runtime_script>();
  std::shared_ptr<told_changes> told = std::make_shared<told_changes>();
  container_supervisor_actor supervisor = fake_supervisor(time.system, told);
  container_listener_actor ears =
      caf::actor_cast<container_listener_actor>(supervisor);
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
    time.ask<container_stopped>(runtime, stop_container{instance, {}, 0});
    log_query query;
    query.instance = instance;
    time.ask<log_excerpt>(runtime, query);
    caf::anon_send(runtime, hear_container{instance});
    time.settle();
    time.ask<container_removed>(runtime, remove_container{instance, {}});
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
  time.ask<container_adopted>(runtime, adopt_container{"old", "actor:7"});
  time.ask<container_adopted>(runtime, adopt_container{"old", "pid 7"});
  CHECK(actors->adopted.size() == 1);
  CHECK(programs->adopted.size() == 1);
}

TEST_CASE_METHOD(switch_test, "an instance that was an actor may be a program "
                              "the next time") {
  start("x", actor_image("move_to"));
  start("x", "roscell/echo:1");
  time.ask<container_stopped>(runtime, stop_container{"x", {}, 0});
  CHECK(programs->stopped.size() == 1);
  CHECK(actors->stopped.empty());
}
