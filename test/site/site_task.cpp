#include "test/site/site_task.hpp"

#include "test/site/site.hpp"

#include <algorithm>

namespace roscell::test {

json task_call::document() const {
  if (!answered())
    return nullptr;
  const auto& outcome = **reply;
  return outcome ? json::parse(outcome->text)
                 : error_reply(to_failure(outcome.error()));
}

bool task_call::accepted() const {
  return !ends && answered() && document().at("type") == "task_accepted";
}

bool task_call::refused() const {
  return answered() && !closed && document().at("type") == "error";
}

bool site_task::end_is_wanted() const {
  return std::any_of(calls.begin(), calls.end(),
                     [](const auto& x) { return x.ends; });
}

json work_step(const std::string& id, const program_script& script,
               const std::string& deployment, const std::string& node) {
  json result{{"id", id},
              {"operation", "work"},
              {"model", "plain"},
              {"parameters", script.parameters()}};
  if (!deployment.empty())
    result["deployment"] = deployment;
  if (!node.empty())
    result["labels"] = {{"is", node}};
  // What is started again is a rule of its own.
  result["restart"] = {{"policy", "never"}};
  return result;
}

site_task& site::add_task(const site_party& coordinator,
                          const std::vector<json>& steps) {
  auto& x = *tasks.emplace_back(std::make_unique<site_task>());
  x.cell = coordinator.index;
  x.name = "t" + std::to_string(tasks.size());
  x.request = {{"type", "task_request"}, {"task", x.name}, {"pipeline", steps}};
  return x;
}

void site::call(site_task& x, const json& document, bool ends) {
  const auto& party = *parties[x.cell];
  auto reply =
      time.ask<request_routed>(party.router, route_request{document.dump()});
  x.last_came_alone =
      std::all_of(x.calls.begin(), x.calls.end(),
                  [](const auto& call) { return call.answered(); });
  x.calls.push_back({ends, now(), std::move(reply)});
}

void site::request(site_task& x) {
  call(x, x.request, false);
}

void site::terminate(site_task& x) {
  call(x, {{"type", "task_termination"}, {"task", x.name}}, true);
}

} // namespace roscell::test
