#include "embedding/task_calls.hpp"

#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <caf/scoped_actor.hpp>

#include <utility>
#include <variant>

namespace roscell::embedding {

namespace {

[[noreturn]] void throw_failure(const failure& why) {
  throw node_error{std::string{to_string(why.code)},
                   why.where.empty() ? why.message
                                     : why.where + ": " + why.message,
                   why.hint};
}

} // namespace

json ask_node(const task_door& door, const json& request,
              std::chrono::milliseconds limit) {
  caf::scoped_actor self{*door.system};
  json answer;
  caf::error gone;
  self->request(door.router, limit,
                route_request{request.dump(-1, ' ', false,
                                           json::error_handler_t::replace),
                              "", "the program around the node"})
      .receive(
          [&](const request_routed& x) {
            answer = json::parse(x.text, nullptr, false);
          },
          [&](caf::error& why) { gone = std::move(why); });
  if (gone)
    throw_failure(to_failure(gone));
  if (answer.value("type", "") == "error")
    throw_failure(failure_from(answer));
  return answer;
}

std::string run_task(const task_door& door, const std::string& request,
                     std::chrono::milliseconds limit) {
  auto parsed = parse_document(request, format_of("", request));
  if (const auto* why = std::get_if<failure>(&parsed))
    throw_failure(*why);
  auto& document = std::get<json>(parsed);
  if (document.is_object())
    document["type"] = task_request::type;
  const auto answer = ask_node(door, document, limit);
  return answer.value("task", "");
}

task_status status_of(const std::vector<task_row>& rows,
                      const std::string& task) {
  task_status result;
  result.task = task;
  result.state = "gone";
  for (const auto& row : rows) {
    if (row.task != task)
      continue;
    result.state = to_string(row.state);
    for (const auto& x : row.instances)
      result.steps.push_back(
          {x.spec.step, x.spec.instance, x.node, to_string(x.state), x.reason});
  }
  return result;
}

task_status status_of_task(const task_door& door, const std::string& task,
                           std::chrono::milliseconds limit) {
  try {
    const auto answer = ask_node(door, message_json(task_query{task}), limit);
    return status_of(answer.get<task_description>().tasks, task);
  } catch (const node_error& why) {
    if (why.code() != to_string(error_code::unknown_task))
      throw;
    return {task, "gone", {}};
  }
}

} // namespace roscell::embedding
