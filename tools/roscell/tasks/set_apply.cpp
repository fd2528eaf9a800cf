#include "tools/roscell/tasks/set_apply.hpp"

#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <chrono>
#include <utility>

namespace roscell::cli {

namespace {

/// To read it, and to look at the cell.
constexpr std::chrono::seconds set_limit{30};
constexpr size_t shown_problems = 5;

json set_request_of(const apply_options& options, json request) {
  request["type"] = task_set_request::type;
  for (const auto* name : {"preempt", "replace", "request_id"})
    request.erase(name);
  if (options.force)
    request["force"] = true;
  return request;
}

task_set_plan ask_for_set(const node_client& node, const json& request) {
  return unless_refused(node.post("/v1/requests", request.dump(), set_limit),
                        false)
      .get<task_set_plan>();
}

std::string problems_text(const task_set_row& row) {
  std::string result;
  for (size_t i = 0; i < row.problems.size() && i < shown_problems; ++i)
    result += (i == 0 ? "" : "; ") + row.problems[i].node + ": "
              + row.problems[i].reason;
  if (row.problems.size() > shown_problems)
    result += "; and " + std::to_string(row.problems.size() - shown_problems)
              + " more";
  return result;
}

/// What is left to be done waits for something that is not there.
bool is_stuck(const task_set_row& row) {
  return !row.problems.empty()
         && row.pending <= static_cast<int64_t>(row.problems.size());
}

command_error not_everywhere(const task_set_row& row) {
  return {exit_refused,
          "set '" + printable(row.task) + "': " + printable(set_text(row)),
          "it is tried again by itself; `roscell tasks " + printable(row.task)
              + "` shows how far it is"};
}

task_set_row wait_for_set(const apply_options& options, const node_client& node,
                          const std::string& set) {
  const auto until =
      std::chrono::steady_clock::now() + parse_duration(options.timeout);
  progress reporter{node,
                    [set](const event& e) { return progress_lines(e, set); }};
  reporter.begin();
  std::string known;
  while (true) {
    const auto now = next_change(node, set, known, until);
    if (now.sets.empty())
      throw command_error{exit_refused,
                          "set '" + printable(set) + "' was stopped"};
    const auto& row = now.sets.front();
    if (row.pending == 0)
      return row;
    if (is_stuck(row) || std::chrono::steady_clock::now() >= until)
      throw not_everywhere(row);
    known = now.mark;
  }
}

task_set_row have_made(const apply_options& options, const node_client& node,
                       const json& request) {
  const auto plan = ask_for_set(node, request);
  task_set_row row;
  row.task = plan.task;
  row.nodes = static_cast<int64_t>(plan.changes.size());
  return options.no_wait ? row : wait_for_set(options, node, plan.task);
}

} // namespace

bool is_set(const json& request) {
  return request.contains("for_each");
}

task_set_plan plan_set(const apply_options& options, const node_client& node,
                       const json& request) {
  auto query = set_request_of(options, request);
  query["dry_run"] = true;
  return ask_for_set(node, query);
}

task_set_row make_set(const apply_options& options, const node_client& node,
                      const json& request) {
  return have_made(options, node, set_request_of(options, request));
}

task_set_row run_set(const apply_options& options, const node_client& node,
                     const json& request, bool replace) {
  auto wanted = set_request_of(options, request);
  wanted["run_again"] = true;
  if (!replace)
    wanted["only_new"] = true;
  return have_made(options, node, wanted);
}

std::string set_text(const task_set_row& row) {
  auto result = "it runs on " + std::to_string(row.running) + " of "
                + std::to_string(row.nodes)
                + (row.nodes == 1 ? " node" : " nodes");
  if (row.nodes == 0 && row.problems.empty())
    result += "; one that comes gets it";
  const auto problems = problems_text(row);
  return problems.empty() ? result : result + "; " + problems;
}

} // namespace roscell::cli
