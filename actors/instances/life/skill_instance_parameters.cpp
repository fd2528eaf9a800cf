#include "actors/core/clocks.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using parameters_promise = caf::typed_response_promise<parameters_set>;

/// One line, whoever has written it.
std::string one_line(const std::string& parameters) {
  const auto values = json::parse(parameters, nullptr, false);
  return (values.is_object() ? values : json::object())
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string name_of(const skill_instance_state& st) {
  return "instance '" + st.row.spec.instance + "'";
}

caf::error refusal(const std::string& why, const std::string& hint) {
  return fail(error_code::conflict, why, "/instance", hint);
}

constexpr const char* restart_instead =
    "`roscell apply` of its task restarts the step with other parameters";

caf::error not_delivered(const skill_instance_state& st,
                         parameter_delivery how) {
  switch (how) {
  case parameter_delivery::no_file:
    return refusal(
        name_of(st)
            + " was started by an earlier roscell, which could not "
              "tell its program of other parameters",
        "`roscell restart` starts it anew; then they can be changed");
  case parameter_delivery::too_long:
    return refusal("all parameters of " + name_of(st)
                       + " together are longer than a program can be told "
                         "while it runs: "
                       + std::to_string(max_parameter_line_bytes / 1024)
                       + " KiB",
                   restart_instead);
  case parameter_delivery::failed:
    return refusal("the program of " + name_of(st)
                       + " has not read what it was told before",
                   "send it again when it does; `roscell logs "
                       + st.row.spec.instance + "` shows what it says");
  default:
    return refusal("the program of " + name_of(st)
                       + " does not listen for other parameters: it was built "
                         "with an earlier roscell, or without its engine",
                   restart_instead);
  }
}

/// Tells the program; the answer will name `last_change`.
parameter_delivery pass_on(skill_instance_pointer self,
                           const std::string& parameters) {
  auto& st = self->state;
  if (!st.config.write_parameters)
    return parameter_delivery::no_listener;
  // Above all that an earlier run of the node has used.
  st.last_change = std::max(st.last_change + 1, unix_now_ms());
  return st.config.write_parameters(st.row.spec.instance, st.last_change,
                                    parameters);
}

/// Puts the program back to what is written down of it.
void pass_on_spec(skill_instance_pointer self) {
  auto& st = self->state;
  if (pass_on(self, one_line(st.row.spec.parameters))
      == parameter_delivery::written)
    st.correction = st.last_change;
}

/// Its node knows them from now on, also when it is started again. Where they
/// cannot be written down the program works with them all the same: a node that
/// is started again is told by its coordinator.
void use_in_spec(skill_instance_pointer self, const std::string& parameters,
                 parameters_promise promise) {
  auto& st = self->state;
  const auto context = st.config.context;
  const auto instance = st.row.spec.instance;
  if (one_line(st.row.spec.parameters) == parameters) {
    promise.deliver(parameters_set{instance});
    return;
  }
  st.row.spec.parameters = parameters;
  report(self);
  auto record = record_of(st);
  record.may_wait = true;
  constexpr auto patience =
      limits::instance::parameters - limits::instance::parameter_answer;
  self->request(st.config.store, patience, record)
      .then(
          [=](const record_stored&) mutable {
            promise.deliver(parameters_set{instance});
          },
          [=](const caf::error& error) mutable {
            context.publish_event(events::store_failed, instance,
                                  {{"message", valid_utf8(sentence(error))}});
            promise.deliver(parameters_set{instance});
          });
}

/// No program runs that would have to be told, or it is told once it does.
caf::result<parameters_set> take_before_it_runs(skill_instance_pointer self,
                                                const std::string& parameters) {
  auto& st = self->state;
  const bool is_same = parameters == one_line(st.row.spec.parameters);
  if (st.adopting || (st.row.state == instance_state::starting && !is_same))
    st.passes_on_when_ready = true;
  auto promise = self->make_response_promise<parameters_set>();
  use_in_spec(self, parameters, promise);
  return promise;
}

void on_taken(skill_instance_pointer self, int64_t number) {
  auto& st = self->state;
  if (st.change && number == st.change->number) {
    const auto change = *std::exchange(st.change, std::nullopt);
    st.works_with_spec = true;
    return use_in_spec(self, change.parameters, change.promise);
  }
  st.works_with_spec = number == st.correction;
  // It has taken what nobody waits for any more.
  if (!st.works_with_spec && !st.change && number >= st.last_change)
    pass_on_spec(self);
}

void on_refused(skill_instance_pointer self, int64_t number,
                const std::string& why) {
  auto& st = self->state;
  if (!st.change || number != st.change->number)
    return;
  auto change = *std::exchange(st.change, std::nullopt);
  change.promise.deliver(refusal(
      "the program of " + name_of(st) + " refuses: "
          + (why.empty() ? std::string{"it does not say why"} : why),
      "its parameters are as they were; " + std::string{restart_instead}));
  if (!st.works_with_spec)
    pass_on_spec(self);
}

} // namespace

caf::result<parameters_set> take_parameters(skill_instance_pointer self,
                                            const set_parameters& request) {
  auto& st = self->state;
  const auto wanted = one_line(request.parameters);
  const bool is_same = wanted == one_line(st.row.spec.parameters);
  if (st.concluding || st.farewell || st.row.state >= instance_state::stopping)
    return refusal(name_of(st) + " is being ended", {});
  if (st.row.state != instance_state::running || st.adopting)
    return take_before_it_runs(self, wanted);
  if (is_same && st.works_with_spec && !st.change)
    return parameters_set{request.instance};
  if (const auto how = pass_on(self, wanted);
      how != parameter_delivery::written)
    return not_delivered(st, how);
  drop_change(self, "another change of its parameters came meanwhile");
  st.change = awaited_parameters{st.last_change, wanted,
                                 self->clock().now()
                                     + limits::instance::parameter_answer,
                                 self->make_response_promise<parameters_set>()};
  st.timer.set(self, st.change->until);
  return st.change->promise;
}

void drop_change(skill_instance_pointer self, const std::string& why) {
  auto& st = self->state;
  if (auto change = std::exchange(st.change, std::nullopt))
    change->promise.deliver(refusal(name_of(st) + ": " + why, {}));
}

void on_change_answered(skill_instance_pointer self,
                        const instance_notified& x) {
  if (self->state.row.state != instance_state::running)
    return;
  if (x.parameters_taken > 0)
    on_taken(self, x.parameters_taken);
  if (x.parameters_refused > 0)
    on_refused(self, x.parameters_refused, x.refusal);
}

void on_change_late(skill_instance_pointer self) {
  auto& st = self->state;
  auto change = *std::exchange(st.change, std::nullopt);
  st.works_with_spec = false;
  change.promise.deliver(
      fail(error_code::timeout,
           "the program of " + name_of(st) + " has not answered for "
               + std::to_string(limits::instance::parameter_answer.count())
               + " s: it is busy with a frame for as long, or hangs",
           "/instance",
           "its parameters are as they were, also where it takes the others "
           "later; `roscell logs "
               + st.row.spec.instance + "` shows what it says"));
}

void pass_on_when_ready(skill_instance_pointer self) {
  if (std::exchange(self->state.passes_on_when_ready, false))
    pass_on_spec(self);
}

} // namespace roscell
