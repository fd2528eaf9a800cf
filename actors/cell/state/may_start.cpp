#include "actors/cell/state/may_start.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

using std::chrono::milliseconds;

namespace {

instance_place place_of(const cell_coordinator_state& st,
                        const instance_spec& spec, const std::string& node) {
  instance_place result{spec.task, spec.step, spec.instance, node};
  result.life = spec.life;
  if (const auto* entry = st.registry.find_name(node))
    result.uuid = entry->row.identity.uuid;
  if (may_move(spec)) {
    result.rule = away_rule::fenced;
    result.after = fence_of(spec);
  } else if (starts_alone(spec)) {
    result.rule = away_rule::alone;
  }
  return result;
}

/// A node may have left the cell without having been lost before.
void look_for_gone_nodes(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& uuid : st.failures.nodes_there())
    if (!st.registry.find_uuid(uuid))
      st.failures.node_gone(uuid, self->clock().now());
}

std::string seconds_until(coordinator_pointer self, const start_hold& x) {
  const auto left = x.until - self->clock().now();
  return std::to_string(std::chrono::ceil<std::chrono::seconds>(left).count())
         + " s";
}

failure hold_failure(coordinator_pointer self, const start_hold& x) {
  const auto& at = x.place;
  const auto what = "'" + at.instance + "'";
  if (at.silent_since && at.rule == away_rule::alone)
    return {error_code::conflict,
            what + " is started by node '" + at.node
                + "' alone, as soon as its host is switched on",
            "/task",
            "wait for the node; if its host stays off, stop the task, and run "
            "it with --force"};
  if (at.silent_since && at.rule == away_rule::fenced)
    return {error_code::conflict,
            "node '" + at.node + "' is away and may still run " + what,
            "/instances",
            "it has ended there in " + seconds_until(self, x)
                + ", and moves by itself then; or say \"terminate\""};
  if (at.silent_since)
    return {error_code::conflict,
            "node '" + at.node + "' is away and may still run " + what,
            "/instances",
            "wait for the node; if it is off for good, release it"};
  return {error_code::conflict,
          "it is unknown whether " + what + " on node '" + at.node
              + "' has ended",
          "/instances", "send it again once it has"};
}

failure still_there(const instance_place& x, const std::string& why,
                    const std::string& when) {
  return {error_code::conflict,
          "'" + x.instance + "' of the task that had this name may still run "
              + "on '" + x.node + "': " + why,
          "/task", "send it again " + when + ", or choose another task id"};
}

} // namespace

bool may_move(const instance_spec& x) {
  return x.life.on_node_loss.policy == loss_action::move;
}

milliseconds fence_of(const instance_spec& x) {
  // As the schema of requests has it; a record may be damaged.
  constexpr double longest_s = 31'536'000;
  return milliseconds{static_cast<int64_t>(
      std::clamp(x.life.on_node_loss.after_s, 0.0, longest_s) * 1000)};
}

bool starts_alone(const instance_spec& x) {
  return boot_action_of(x.life) == boot_action::start;
}

std::optional<failure> why_not_yet(coordinator_pointer self,
                                   const start_request& request) {
  look_for_gone_nodes(self);
  const auto& failures = self->state.failures;
  const auto now = self->clock().now();
  if (const auto x =
          failures.hold(request.task, request.step, now, request.replaces))
    return hold_failure(self, *x);
  const auto* old = failures.find(request.replaces, now);
  // Where it waits for its node, whoever asks knows that the node is off.
  if (!old
      || (old->silent_since ? old->rule == away_rule::waits : request.beside))
    return std::nullopt;
  const auto until = old->silent_since && old->rule == away_rule::fenced
                         ? *old->silent_since + old->after
                         : node_failures::time_point::max();
  return hold_failure(self, {*old, until});
}

bool note_start(coordinator_pointer self, const instance_spec& spec,
                const std::string& node) {
  return self->state.failures.order(place_of(self->state, spec, node));
}

void note_reported(coordinator_pointer self, const instance_row& row,
                   const std::string& node) {
  auto& st = self->state;
  // A node that registers says less of it than its task knows.
  const auto* placed = st.deployments.find(row.spec.instance);
  if (is_live(row.state))
    note_start(self, placed ? placed->spec : row.spec, node);
  else if (const auto* entry = st.registry.find_name(node))
    note_gone(self, entry->row.identity.uuid, row.spec.instance);
}

void note_gone(coordinator_pointer self, const std::string& uuid,
               const std::string& instance) {
  auto& st = self->state;
  st.failures.end(uuid, instance);
  if (!st.pending.remains.empty())
    wake(self);
}

bool is_surely_gone(coordinator_pointer self, const std::string& instance) {
  return self->state.failures.find(instance, self->clock().now()) == nullptr;
}

std::optional<failure> remains_of(coordinator_pointer self,
                                  const std::string& task, bool force) {
  look_for_gone_nodes(self);
  auto& failures = self->state.failures;
  if (force)
    failures.forget_alone(task);
  const auto x = failures.hold_of_task(task, self->clock().now());
  if (!x)
    return std::nullopt;
  if (!x->place.silent_since)
    return still_there(x->place, "its node is ending it", "once it has ended");
  if (x->place.rule == away_rule::alone)
    return hold_failure(self, *x);
  return still_there(x->place, "its node is away",
                     "in " + seconds_until(self, *x)
                         + ", when it has been ended there");
}

task_record with_left(coordinator_pointer self, task_record record) {
  record.left.clear();
  for (const auto& x :
       self->state.failures.places_of(record.task, self->clock().now())) {
    const auto is_it = [&](const auto& spec) {
      return spec.instance == x.instance;
    };
    if (std::none_of(record.specs.begin(), record.specs.end(), is_it))
      record.left.push_back({x.instance, x.step, x.node, x.life});
  }
  return record;
}

void restore_places(coordinator_pointer self,
                    const std::vector<task_record>& stored) {
  auto& st = self->state;
  for (const auto& record : stored)
    for (const auto& x : deployments_in(record))
      if (!x.end)
        note_start(self, x.spec, x.node);
  for (const auto& record : stored)
    for (const auto& x : record.left) {
      instance_spec spec;
      spec.task = record.task;
      spec.step = x.step;
      spec.instance = x.instance;
      spec.life = x.life;
      note_start(self, spec, x.node);
    }
  // What a record has left on a node that has gone since holds nothing any
  // more.
  look_for_gone_nodes(self);
  for (const auto& uuid : st.failures.nodes_there())
    if (uuid != st.setup.self.uuid)
      st.failures.node_lost(uuid, self->clock().now());
}

store_record record_of_remains(coordinator_pointer self,
                               const std::string& task) {
  auto& st = self->state;
  auto& remains = st.pending.remains;
  const auto hold = st.failures.hold_of_task(task, self->clock().now());
  if (!hold) {
    remains.erase(task);
    return {"tasks", task, ""};
  }
  remains[task] = hold->until;
  set_timer(self);
  task_record record;
  record.task = task;
  record.state = task_state::terminating;
  return {"tasks", task, json(with_left(self, std::move(record))).dump()};
}

void forget_past_remains(coordinator_pointer self) {
  auto& st = self->state;
  auto& remains = st.pending.remains;
  st.failures.forget_ended(self->clock().now());
  for (auto i = remains.begin(); i != remains.end();) {
    const auto hold = st.failures.hold_of_task(i->first, self->clock().now());
    const bool is_begun_anew = st.tasks.find(i->first) != nullptr;
    if (hold && !is_begun_anew) {
      i->second = hold->until;
      ++i;
      continue;
    }
    if (!is_begun_anew)
      persist_record(self, {"tasks", i->first, ""});
    i = remains.erase(i);
  }
}

} // namespace roscell
