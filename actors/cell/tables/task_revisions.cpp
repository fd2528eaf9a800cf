#include "actors/cell/limits.hpp"
#include "actors/cell/tables/task_table.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <utility>
#include <variant>

/// The requests that a task has had, and its change from one to the next.
namespace roscell {

namespace {

/// What is kept of former requests: the newest that fit.
void drop_oldest(std::vector<task_revision>& former) {
  size_t bytes = 0;
  size_t kept = 0;
  for (auto x = former.rbegin(); x != former.rend(); ++x, ++kept) {
    bytes += x->request.size();
    if (kept == limits::task::former_requests
        || bytes > limits::task::former_request_bytes)
      break;
  }
  former.erase(former.begin(), former.end() - static_cast<ptrdiff_t>(kept));
}

/// The instance of a step after the update; null: its present one.
const replacement* fresh_of(const updated_task& now, const std::string& step) {
  const auto found =
      std::find_if(now.fresh.begin(), now.fresh.end(),
                   [&](const auto& x) { return x.spec.step == step; });
  return found == now.fresh.end() ? nullptr : &*found;
}

/// Where the steps are, in the order of the request.
std::string decision_after(const task_record& record, const updated_task& now) {
  const auto document = json::parse(record.accepted, nullptr, false);
  if (document.is_discarded())
    return record.accepted;
  auto decoded = decode<task_accepted>(document);
  auto* decision = std::get_if<task_accepted>(&decoded);
  if (!decision)
    return record.accepted;
  std::vector<step_allocation> allocations;
  for (const auto& step : now.steps) {
    if (const auto* x = fresh_of(now, step))
      allocations.push_back(x->place);
    else
      std::copy_if(decision->allocations.begin(), decision->allocations.end(),
                   std::back_inserter(allocations),
                   [&](const auto& y) { return y.step == step; });
  }
  decision->allocations = std::move(allocations);
  return message_json(*decision).dump();
}

std::map<std::string, std::string> builds_of(const task_record& record) {
  std::map<std::string, std::string> result;
  for (const auto& x : record.specs)
    if (std::find(record.tentative.begin(), record.tentative.end(), x.instance)
        == record.tentative.end())
      result[x.step] = x.skill;
  return result;
}

/// How long a request lets its task run has changed.
bool has_other_timeout(const std::string& x, const std::string& y) {
  const auto timeout = [](const std::string& text) {
    const auto document = json::parse(text, nullptr, false);
    return document.is_object() ? document.value("timeout_s", json{}) : json{};
  };
  return timeout(x) != timeout(y);
}

} // namespace

void revise(revision_history& history, std::string former,
            std::map<std::string, std::string> builds, int64_t now_unix_ms) {
  history.former.push_back({history.revision, history.since_unix_ms,
                            std::move(former), std::move(builds)});
  drop_oldest(history.former);
  ++history.revision;
  history.since_unix_ms = now_unix_ms;
}

std::vector<task_revision> revisions_of(const std::string& task,
                                        const task_entry& entry,
                                        const deployment_table& deployments) {
  const auto& history = entry.revisions;
  auto result = history.former;
  result.push_back(
      {history.revision, history.since_unix_ms, entry.request, {}});
  for (const auto& x : deployments.of_task(task))
    if (!x.tentative)
      result.back().builds[x.spec.step] = x.spec.skill;
  for (auto& x : result)
    if (x.since_unix_ms == 0)
      x.since_unix_ms = entry.submitted_unix_ms;
  return result;
}

task_record with_update_begun(task_record record,
                              const std::vector<replacement>& fresh,
                              int64_t now_unix_ms) {
  record.update = {now_unix_ms, ""};
  return with_tentative(std::move(record), fresh);
}

task_record with_update_done(task_record record, const updated_task& now,
                             int64_t now_unix_ms) {
  auto builds = builds_of(record);
  record.accepted = decision_after(record, now);
  std::vector<instance_spec> specs;
  std::vector<std::string> nodes;
  std::vector<std::string> kept;
  for (const auto& step : now.steps) {
    const auto* fresh = fresh_of(now, step);
    for (size_t i = 0; i < record.specs.size(); ++i) {
      const auto& x = record.specs[i];
      if (x.step != step || (fresh && x.instance != fresh->spec.instance))
        continue;
      kept.push_back(x.instance);
      specs.push_back(x);
      nodes.push_back(record.nodes[i]);
    }
  }
  std::vector<std::string> gone;
  for (const auto& x : record.specs)
    if (std::find(kept.begin(), kept.end(), x.instance) == kept.end())
      gone.push_back(x.instance);
  record = without(std::move(record), gone);
  record.specs = std::move(specs);
  record.nodes = std::move(nodes);
  for (const auto& x : now.fresh) {
    auto& tentative = record.tentative;
    tentative.erase(
        std::remove(tentative.begin(), tentative.end(), x.spec.instance),
        tentative.end());
  }
  record.update = {};
  if (has_other_timeout(record.request, now.request))
    record.deadline_unix_ms = 0;
  revise(record.revisions, std::move(record.request), std::move(builds),
         now_unix_ms);
  record.request = now.request;
  return with_deadline(with_ends(std::move(record), {}, now_unix_ms),
                       now_unix_ms);
}

task_record with_update_reverted(task_record record,
                                 const std::vector<std::string>& fresh,
                                 const std::string& problem,
                                 int64_t now_unix_ms) {
  record = without(std::move(record), fresh);
  record.update = {0, problem};
  return with_ends(std::move(record), {}, now_unix_ms);
}

} // namespace roscell
