#include "actors/cell/tables/task_table.hpp"

#include "messages/codec/instantiate.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <utility>
#include <variant>

/// The records of tasks: what is proposed of them, and what they say.
namespace roscell {

ROSCELL_CODEC(left_instance)
ROSCELL_CODEC(revision_history)
ROSCELL_CODEC(update_record)
ROSCELL_CODEC(task_record)

namespace {

/// Requests that are remembered as of one run: a person or a program sends one,
/// and the same again where it got no answer.
constexpr size_t most_request_ids = 16;

bool has(const std::vector<std::string>& list, const std::string& wanted) {
  return std::find(list.begin(), list.end(), wanted) != list.end();
}

const instance_end* find_end(const task_record& record,
                             const std::string& instance) {
  for (const auto& x : record.ends)
    if (x.instance == instance)
      return &x;
  return nullptr;
}

/// A record of another version may lack parts of it.
task_accepted decision_in(const std::string& task, const std::string& text) {
  task_accepted result;
  result.task = task;
  const auto document = json::parse(text, nullptr, false);
  if (document.is_discarded())
    return result;
  auto decoded = decode<task_accepted>(document);
  if (auto* decision = std::get_if<task_accepted>(&decoded))
    result = std::move(*decision);
  return result;
}

/// Where instances are is written down once, so it is left out here.
std::string decision_text(task_accepted decision) {
  decision.instances.clear();
  return message_json(decision).dump();
}

void add_instance(task_record& record, const replacement& x) {
  record.specs.push_back(x.spec);
  record.nodes.push_back(x.place.node);
}

void drop_order(task_record& record, const std::string& instance) {
  auto& orders = record.orders;
  orders.erase(
      std::remove_if(orders.begin(), orders.end(),
                     [&](const auto& x) { return x.instance == instance; }),
      orders.end());
}

/// The new instance stands where the old one stood, which has no end any more.
void replace(task_record& record, task_accepted& decision,
             const replacement& x) {
  drop_order(record, x.old_instance);
  for (size_t i = 0; i < record.specs.size(); ++i)
    if (record.specs[i].instance == x.old_instance) {
      record.specs[i] = x.spec;
      record.nodes[i] = x.place.node;
    }
  auto& ends = record.ends;
  ends.erase(std::remove_if(ends.begin(), ends.end(),
                            [&](const auto& end) {
                              return end.instance == x.old_instance;
                            }),
             ends.end());
  for (auto& allocation : decision.allocations)
    if (allocation.step == x.spec.step)
      allocation = x.place;
}

/// How long a request lets its task run; 0: for ever.
double timeout_in(const std::string& request) {
  const auto document = json::parse(request, nullptr, false);
  if (!document.is_object())
    return 0;
  const auto found = document.find("timeout_s");
  return found != document.end() && found->is_number() ? found->get<double>()
                                                       : 0;
}

/// The state of a running task, from the ends of its steps.
task_state state_after(const task_record& record) {
  bool failed = false;
  for (const auto& spec : record.specs) {
    const auto* end = find_end(record, spec.instance);
    if (!end)
      return task_state::running;
    failed =
        failed || end->state != instance_state::stopped || end->exit_code != 0;
  }
  return failed ? task_state::failed : task_state::finished;
}

} // namespace

task_record record_of(const std::string& task, const task_entry& entry,
                      const deployment_table& deployments) {
  task_record result{task, entry.request, entry.accepted, entry.state,
                     entry.submitted_unix_ms};
  result.ended_unix_ms = entry.ended_unix_ms;
  result.run = entry.run;
  result.request_ids = entry.request_ids;
  result.orders = entry.orders;
  result.deadline_unix_ms = entry.deadline_unix_ms;
  result.revisions = entry.revisions;
  result.update = entry.update;
  for (const auto& x : deployments.of_task(task)) {
    result.specs.push_back(x.spec);
    result.nodes.push_back(x.node);
    if (x.end)
      result.ends.push_back(*x.end);
    if (x.tentative)
      result.tentative.push_back(x.spec.instance);
  }
  return result;
}

std::vector<deployment> deployments_in(const task_record& record) {
  std::vector<deployment> result;
  for (size_t i = 0; i < record.specs.size() && i < record.nodes.size(); ++i) {
    deployment x{record.specs[i], record.nodes[i], std::nullopt,
                 has(record.tentative, record.specs[i].instance)};
    if (const auto* end = find_end(record, x.spec.instance))
      x.end = *end;
    result.push_back(std::move(x));
  }
  return result;
}

task_record with_placement(task_record record, const task_accepted& decision,
                           std::vector<instance_spec> specs,
                           std::vector<std::string> nodes) {
  record.accepted = decision_text(decision);
  record.specs = std::move(specs);
  record.nodes = std::move(nodes);
  record.ends.clear();
  record.tentative.clear();
  record.orders.clear();
  return record;
}

task_record with_request(task_record record, const std::string& id) {
  auto& ids = record.request_ids;
  if (has(ids, id))
    return record;
  ids.push_back(id);
  if (ids.size() > most_request_ids)
    ids.erase(ids.begin());
  return record;
}

task_record with_renamed(task_record record, const std::string& from,
                         const std::string& to) {
  std::replace(record.nodes.begin(), record.nodes.end(), from, to);
  auto decision = decision_in(record.task, record.accepted);
  for (auto& allocation : decision.allocations)
    if (allocation.node == from)
      allocation.node = to;
  record.accepted = decision_text(std::move(decision));
  return record;
}

task_record with_state(task_record record, task_state state) {
  record.state = state;
  return record;
}

task_record with_ends(task_record record, const std::vector<instance_end>& ends,
                      int64_t now_unix_ms) {
  for (const auto& x : ends)
    if (!find_end(record, x.instance))
      record.ends.push_back(x);
  // An update that goes on gives it other steps, or puts back those that it
  // had.
  if (record.state == task_state::running && record.update.begun_unix_ms == 0)
    record.state = state_after(record);
  if (!is_settled(record.state))
    return record;
  record.deadline_unix_ms = 0;
  if (record.ended_unix_ms == 0)
    record.ended_unix_ms = now_unix_ms;
  return record;
}

task_record with_deadline(task_record record, int64_t now_unix_ms) {
  if (record.state != task_state::running || record.deadline_unix_ms > 0)
    return record;
  constexpr double ms_per_s = 1000;
  if (const auto timeout_s = timeout_in(record.request); timeout_s > 0)
    record.deadline_unix_ms =
        now_unix_ms + static_cast<int64_t>(timeout_s * ms_per_s);
  return record;
}

task_record with_order(task_record record, const end_order& order) {
  if (find_end(record, order.instance))
    return record;
  drop_order(record, order.instance);
  record.orders.push_back(order);
  return record;
}

task_record without_order(task_record record, const std::string& instance) {
  drop_order(record, instance);
  return record;
}

task_record with_tentative(task_record record,
                           const std::vector<replacement>& moved) {
  for (const auto& x : moved) {
    add_instance(record, x);
    record.tentative.push_back(x.spec.instance);
  }
  return record;
}

task_record with_replaced(task_record record,
                          const std::vector<replacement>& moved) {
  auto decision = decision_in(record.task, record.accepted);
  for (const auto& x : moved) {
    record = without(std::move(record), {x.spec.instance});
    if (!find_end(record, x.old_instance))
      replace(record, decision, x);
  }
  record.accepted = decision_text(std::move(decision));
  return record;
}

task_record with_restarted(task_record record,
                           const std::vector<replacement>& restarted) {
  auto decision = decision_in(record.task, record.accepted);
  for (const auto& x : restarted) {
    record = without(std::move(record), {x.spec.instance});
    replace(record, decision, x);
  }
  record.accepted = decision_text(std::move(decision));
  record.state = task_state::running;
  record.ended_unix_ms = 0;
  return record;
}

task_record without(task_record record,
                    const std::vector<std::string>& instances) {
  for (size_t i = record.specs.size(); i-- > 0;)
    if (has(instances, record.specs[i].instance)) {
      record.specs.erase(record.specs.begin() + static_cast<ptrdiff_t>(i));
      record.nodes.erase(record.nodes.begin() + static_cast<ptrdiff_t>(i));
    }
  auto& tentative = record.tentative;
  tentative.erase(
      std::remove_if(tentative.begin(), tentative.end(),
                     [&](const auto& x) { return has(instances, x); }),
      tentative.end());
  auto& ends = record.ends;
  ends.erase(
      std::remove_if(ends.begin(), ends.end(),
                     [&](const auto& x) { return has(instances, x.instance); }),
      ends.end());
  for (const auto& instance : instances)
    drop_order(record, instance);
  return record;
}

std::optional<task_record> restored(task_record record) {
  if (record.state == task_state::deploying
      || record.state == task_state::terminating)
    return std::nullopt;
  if (record.update.begun_unix_ms > 0)
    record.update = {0, "the coordinator ended while the task was updated"};
  const auto tentative = record.tentative;
  return without(std::move(record), tentative);
}

task_accepted reply_of(const std::string& task, const task_entry& entry,
                       const deployment_table& deployments) {
  auto result = decision_in(task, entry.accepted);
  result.instances.clear();
  result.run = entry.run;
  for (const auto& x : deployments.of_task(task)) {
    if (x.tentative)
      continue;
    result.instances.push_back({x.spec.step, x.spec.instance, x.node});
    for (auto& allocation : result.allocations)
      if (allocation.step == x.spec.step)
        allocation.node = x.node;
  }
  return result;
}

} // namespace roscell
