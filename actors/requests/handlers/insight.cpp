#include "actors/requests/handlers/insight.hpp"

#include <map>
#include <utility>

namespace roscell {

void tell_placement(const request_context& context, task_placement_query query,
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

} // namespace roscell
