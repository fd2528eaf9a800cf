#pragma once

#include "actors/instances/life/skill_instance.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <memory>
#include <string>

namespace roscell::test {

/// One real skill instance between a fake runtime, store and supervisor.
struct instance_bench : virtual_time {
  instance_bench() {
    config.context = context;
    config.supervisor = fake_supervisor(system, reported);
    config.runtime = fake_runtime(system, runtime);
    config.store = fake_store(system, store);
    config.skills = std::make_shared<current_skills>(catalogue.skills);
    config.row.spec = echo_spec(catalogue.hash, "i");
    config.row.node = "n";
  }

  ~instance_bench() {
    kill(config.supervisor);
    kill(config.runtime);
    kill(config.store);
  }

  void start() {
    instance = roscell::spawn(system, context, skill_instance, config);
    caf::anon_send(instance, start_instance{});
    settle();
  }

  void start_ready() {
    start();
    ready();
  }

  /// As a node finds it in its records after a restart.
  void adopt_as(instance_state state, const container_adopted& found) {
    config.adopt = true;
    config.row.state = state;
    if (state >= instance_state::running)
      config.row.container = "c1";
    runtime->adoption = found;
    start();
  }

  void ready() {
    notify(true, true);
  }

  void alive() {
    notify(false, true);
  }

  void notify(bool is_ready, bool is_alive) {
    caf::anon_send(
        instance, instance_notified{"i", is_ready, is_alive, false, {}, false});
    settle();
  }

  void exits(int code, const std::string& container = "c1") {
    caf::anon_send(instance, container_exited{"i", container, code});
    settle();
  }

  void stop(const std::string& reason = "asked to") {
    caf::anon_send(instance, stop_instance{reason, false});
    settle();
  }

  void stop_by_force() {
    caf::anon_send(instance, stop_instance{"asked to", true});
    settle();
  }

  void answer_start() {
    runtime->answer();
    settle();
  }

  /// Time passes while nobody of this process runs.
  void jump(std::chrono::milliseconds span) {
    scheduler.clock().advance_time(span);
    settle();
  }

  instance_state state() const {
    return reported->last().state;
  }

  std::string reason() const {
    return reported->last().reason;
  }

  echo_catalogue catalogue;
  std::shared_ptr<reported_changes> reported =
      std::make_shared<reported_changes>();
  std::shared_ptr<runtime_script> runtime = std::make_shared<runtime_script>();
  std::shared_ptr<store_script> store = std::make_shared<store_script>();
  skill_instance_config config;
  skill_instance_actor instance;
};

/// One whose program is ready.
struct ready_bench : instance_bench {
  ready_bench() {
    start_ready();
  }
};

} // namespace roscell::test
