#include "actors/requests/handlers/insight.hpp"

#include "actors/core/answer_limits.hpp"

#include <map>
#include <utility>

namespace roscell {

void report_placement(const request_context& context,
                      task_placement_query query,
                      outcome<task_placement> done) {
  if (auto known = context.history().placement(query.task))
    return done.deliver(*std::move(known));
  done.fail(
      failure{error_code::unknown_task,
              "no decision about a task '" + query.task + "' is kept", "/task",
              "the latest " + std::to_string(request_history::max_placements)
                  + " since the coordinator's start are; `roscell tasks "
                  + query.task + " --history` goes back further"});
}

void list_traces(const request_context& context, request_trace_query query,
                 outcome<request_traces> done) {
  std::map<uint64_t, std::string> names;
  for (auto& row : context.home().directory->rows())
    names[row.id] = std::move(row.name);
  done.deliver({context.history().traces(query.subject, [&](uint64_t id) {
    const auto i = names.find(id);
    return i == names.end() ? "an actor that has ended" : i->second;
  })});
}

void read_resources(const request_context& context, fresh_cell_query,
                    outcome<cell_query> done) {
  // What has been read is in the coordinator's registry then.
  ask<cell_resources>(context, context.services->coordinator,
                      limits::local::answer, collect_resources{}, done,
                      [done](const cell_resources&) { done.deliver({}); });
}

void report_cell(const request_context& context, cell_query query,
                 outcome<cell_description> done) {
  ask<cell_description>(
      context, context.services->coordinator, limits::local::answer, query,
      done, [done](cell_description cell) { done.deliver(std::move(cell)); });
}

} // namespace roscell
