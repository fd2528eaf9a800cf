#include "actors/skill_instance.hpp"

#include "actors/edge/utf8.hpp"
#include "actors/instance_environment.hpp"
#include "actors/instance_words.hpp"
#include "actors/wall_clock.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using self_pointer =
    skill_instance_actor::stateful_pointer<skill_instance_state>;

using limits = skill_instance_state;

/// A request whose answer is dropped once the instance has moved on.
template <class Reply, class Handle, class Request, class F, class G>
void ask(self_pointer self, const Handle& whom, std::chrono::milliseconds limit,
         const Request& what, F on_reply, G on_error) {
  const auto phase = self->state.phase;
  self->request(whom, limit, what)
      .then(
          [=](const Reply& x) {
            if (self->state.phase == phase)
              on_reply(x);
          },
          [=](const caf::error& x) {
            if (self->state.phase == phase)
              on_error(x);
          });
}

std::string sentence(const caf::error& error) {
  const auto why = to_failure(error);
  return why.hint.empty() ? why.message : why.message + " (" + why.hint + ")";
}

/// The end of a build's log, which goes along with its failure.
std::string log_tail_of(const caf::error& error) {
  const auto details = json::parse(to_failure(error).details, nullptr, false);
  return details.is_object() ? details.value("log_tail", "") : std::string{};
}

void record_event(self_pointer self, const char* fact) {
  const auto& st = self->state;
  const auto& row = st.row;
  json data{{"task", row.spec.task},
            {"step", row.spec.step},
            {"state", to_string(row.state)}};
  if (!row.reason.empty())
    data["reason"] = row.reason;
  if (row.exit_code >= 0)
    data["exit_code"] = row.exit_code;
  st.config.context.tell(fact, row.spec.instance, data);
}

void report(self_pointer self) {
  self->send(self->state.config.supervisor, instance_changed{self->state.row});
}

void set_state(self_pointer self, instance_state next,
               const std::string& reason) {
  auto& st = self->state;
  ++st.phase;
  st.deadline.reset();
  st.row.state = next;
  st.row.since_unix_ms = unix_now_ms();
  // It may quote a path, which may have any bytes.
  st.row.reason = valid_utf8(reason.substr(0, limits::reason_bytes));
  record_event(self, "instance_changed");
}

void enter(self_pointer self, instance_state next,
           const std::string& reason = {}) {
  set_state(self, next, reason);
  report(self);
}

void limit(self_pointer self, std::chrono::milliseconds span) {
  auto& st = self->state;
  st.deadline = self->clock().now() + span;
  st.timer.set(self, *st.deadline);
}

store_record record_of(const instance_row& row) {
  const json value = row;
  return {"instances", row.spec.instance,
          value.dump(-1, ' ', false, json::error_handler_t::replace)};
}

void finish(self_pointer self, instance_state last, const std::string& reason) {
  set_state(self, last, reason);
  // Before the report, after which the supervisor may remove the record.
  // Without a sender: nobody is left to read the answer.
  caf::anon_send(self->state.config.store, record_of(self->state.row));
  report(self);
  self->quit();
}

/// The program has ended, or there never was one.
void conclude(self_pointer self, instance_state last,
              const std::string& reason) {
  auto& st = self->state;
  ++st.phase;
  st.deadline.reset();
  st.concluding = true;
  if (last == instance_state::stopped)
    return finish(self, last, reason);
  log_query query;
  query.instance = st.row.spec.instance;
  ask<log_excerpt>(
      self, st.config.runtime, limits::disk_limit, query,
      [=](const log_excerpt& log) {
        if (!log.text.empty())
          self->state.row.log_tail =
              last_bytes(log.text, limits::log_tail_bytes);
        finish(self, last, reason);
      },
      [=](const caf::error&) { finish(self, last, reason); });
}

/// Ends the program, then the instance, which will be `last`.
void take_down(self_pointer self, instance_state last,
               const std::string& reason,
               std::chrono::milliseconds grace = limits::stop_grace) {
  auto& st = self->state;
  enter(self, instance_state::stopping, reason);
  ask<container_stopped>(
      self, st.config.runtime, grace + limits::stop_limit,
      stop_container{st.row.spec.instance, st.row.container, grace.count()},
      [=](const container_stopped& x) {
        self->state.row.exit_code = x.exit_code;
        conclude(self, last, reason);
      },
      [=](const caf::error& error) {
        conclude(self, instance_state::failed,
                 reason + "; it could not be ended: " + sentence(error));
      });
}

/// Writes how things stand. A restarted node finds the program without it,
/// only less of its story, so a failure is no reason to end the program.
void note(self_pointer self) {
  auto& st = self->state;
  const auto context = st.config.context;
  const auto instance = st.row.spec.instance;
  self->request(st.config.store, limits::disk_limit, record_of(st.row))
      .then([](const record_stored&) {},
            [=](const caf::error& error) {
              context.tell("store_failed", instance,
                           {{"message", valid_utf8(sentence(error))}});
            });
}

void on_running(self_pointer self) {
  enter(self, instance_state::running);
  limit(self, watchdog_interval);
  note(self);
}

void on_started(self_pointer self, const std::string& container) {
  self->state.row.container = container;
  if (self->state.ready)
    return on_running(self);
  report(self);
  limit(self, limits::ready_limit);
  note(self);
}

const deployment_option* find_deployment(const skill_folder& folder,
                                         const instance_spec& spec) {
  for (const auto& model : folder.skill.descriptor.models)
    if (model.name == spec.model)
      for (const auto& option : model.deployments)
        if (option.name == spec.deployment)
          return &option;
  return nullptr;
}

void on_built(self_pointer self, const std::string& image,
              const std::vector<std::string>& command,
              const deployment_option& option) {
  auto& st = self->state;
  const auto& spec = st.row.spec;
  st.row.image = image;
  enter(self, instance_state::starting);
  start_container wish;
  wish.instance = spec.instance;
  wish.image = image;
  wish.command = command;
  wish.environment = instance_environment(spec, option);
  wish.labels = {
      {"task", spec.task}, {"instance", spec.instance}, {"cell", spec.cell}};
  wish.limits = spec.resources;
  wish.gpu = spec.gpu;
  wish.input = spec.input;
  wish.output = spec.output;
  wish.devices = option.devices;
  wish.volumes = option.volumes;
  ask<container_started>(
      self, st.config.runtime, limits::start_limit, wish,
      [=](const container_started& x) { on_started(self, x.container); },
      [=](const caf::error& error) {
        take_down(self, instance_state::failed, sentence(error));
      });
}

void build(self_pointer self) {
  auto& st = self->state;
  const auto* folder = st.config.skills->find(st.row.spec.skill);
  const auto* option =
      folder != nullptr ? find_deployment(*folder, st.row.spec) : nullptr;
  if (option == nullptr)
    return conclude(self, instance_state::failed,
                    "this node does not have its skill any more");
  enter(self, instance_state::building);
  const auto command = folder->skill.descriptor.entry_point;
  ask<image_prepared>(
      self, st.config.runtime, limits::build_limit,
      prepare_image{st.row.spec.instance, st.row.spec.operation,
                    folder->path.string(), folder->skill.hash, command,
                    option->base_image},
      [=, chosen = *option](const image_prepared& x) {
        on_built(self, x.image, command, chosen);
      },
      [=](const caf::error& error) {
        self->state.row.log_tail =
            last_bytes(log_tail_of(error), limits::log_tail_bytes);
        conclude(self, instance_state::failed, sentence(error));
      });
}

/// The intent is on disk before anything is started: a node that is restarted
/// must know what to look for.
void begin_anew(self_pointer self) {
  enter(self, instance_state::pending);
  ask<record_stored>(
      self, self->state.config.store, limits::disk_limit,
      record_of(self->state.row), [=](const record_stored&) { build(self); },
      [=](const caf::error& error) {
        conclude(self, instance_state::failed,
                 "it cannot be recorded: " + sentence(error));
      });
}

void resume(self_pointer self, const std::string& container) {
  auto& st = self->state;
  ++st.phase;
  st.row.container = container;
  switch (st.row.state) {
  case instance_state::running:
    record_event(self, "instance_adopted");
    report(self);
    return limit(self, watchdog_interval);
  case instance_state::stopping:
    return take_down(self, instance_state::stopped, st.row.reason);
  default:
    // Its READY=1 comes again with its next sign of life.
    st.row.state = instance_state::starting;
    record_event(self, "instance_adopted");
    report(self);
    return limit(self, limits::ready_limit);
  }
}

void on_found_ended(self_pointer self, const container_adopted& x) {
  auto& st = self->state;
  st.row.exit_code = x.exit_code;
  if (st.row.state == instance_state::stopping)
    conclude(self, instance_state::stopped, st.row.reason);
  else if (st.row.state == instance_state::running && x.exit_code == 0)
    conclude(self, instance_state::stopped, "finished");
  else
    conclude(self, instance_state::failed,
             "it ended " + exit_words(x.exit_code)
                 + " while the node was away");
}

void on_adopted(self_pointer self, const container_adopted& x) {
  const auto& row = self->state.row;
  const bool was_started = !x.container.empty() || !row.container.empty()
                           || row.state >= instance_state::running;
  if (x.running)
    resume(self, x.container);
  else if (was_started)
    on_found_ended(self, x);
  else
    begin_anew(self);
}

void adopt(self_pointer self) {
  auto& st = self->state;
  ask<container_adopted>(
      self, st.config.runtime, limits::start_limit,
      adopt_container{st.row.spec.instance, st.row.container},
      [=](const container_adopted& x) { on_adopted(self, x); },
      [=](const caf::error& error) {
        take_down(self, instance_state::failed,
                  "it cannot be adopted: " + sentence(error));
      });
}

void on_start(self_pointer self) {
  auto& st = self->state;
  if (std::exchange(st.begun, true))
    return;
  st.config.adopt ? adopt(self) : begin_anew(self);
}

void on_stop(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  const auto before_container = !st.config.adopt && st.row.container.empty()
                                && st.row.state < instance_state::starting;
  if (st.concluding || (st.begun && st.row.state == instance_state::stopping))
    return;
  st.begun = true;
  if (before_container)
    conclude(self, instance_state::stopped, reason);
  else
    take_down(self, instance_state::stopped, reason);
}

void on_notified(self_pointer self, const instance_notified& x) {
  auto& st = self->state;
  if (st.concluding)
    return;
  if (x.ready && st.row.state == instance_state::starting) {
    st.ready = true;
    // Else the runtime's answer is still on its way.
    if (!st.row.container.empty())
      return on_running(self);
  }
  if (x.alive && st.row.state == instance_state::running)
    limit(self, watchdog_interval);
}

void on_exited(self_pointer self, const container_exited& x) {
  auto& st = self->state;
  if (st.concluding || x.container != st.row.container)
    return;
  st.row.exit_code = x.exit_code;
  if (st.row.state == instance_state::running && x.exit_code == 0)
    conclude(self, instance_state::stopped, "finished");
  else if (st.row.state == instance_state::running)
    conclude(self, instance_state::failed,
             "it ended " + exit_words(x.exit_code));
  else if (st.row.state == instance_state::starting)
    conclude(self, instance_state::failed,
             "it ended " + exit_words(x.exit_code) + " before it was ready");
}

void on_alarm(self_pointer self) {
  using std::to_string;
  auto& st = self->state;
  if (!st.deadline)
    return;
  if (self->clock().now() < *st.deadline)
    return st.timer.set(self, *st.deadline);
  if (st.row.state == instance_state::running)
    // What hangs does not listen, so force comes at once.
    take_down(self, instance_state::failed,
              "no sign of life for " + to_string(watchdog_interval.count())
                  + " s",
              std::chrono::milliseconds{0});
  else
    take_down(self, instance_state::failed,
              "it was not ready within "
                  + to_string(limits::ready_limit.count()) + " s");
}

json describe(const skill_instance_state& st) {
  return {{"instance", st.row.spec.instance},
          {"task", st.row.spec.task},
          {"state", to_string(st.row.state)},
          {"container", st.row.container},
          {"phase", st.phase}};
}

} // namespace

skill_instance_actor::behavior_type
skill_instance(self_pointer self, const skill_instance_config& config) {
  self->state.config = config;
  self->state.row = config.row;
  self->monitor(config.supervisor);
  // The program goes on, and the next supervisor adopts it.
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) { return state_of(describe(self->state)); },
      [self](const start_instance&) { on_start(self); },
      [self](const stop_instance& x) { on_stop(self, x.reason); },
      [self](const container_exited& x) { on_exited(self, x); },
      [self](const instance_notified& x) { on_notified(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell
