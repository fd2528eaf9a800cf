#include "tools/roscell/cells/cell_export.hpp"

#include "actors/builds/limits.hpp"
#include "actors/edge/http/http_target.hpp"
#include "messages/task_update.hpp"
#include "tools/roscell/cells/cell_plan.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/cell_skills.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds query_limit{15};
/// Only what goes on: what has ended would run once more elsewhere.
bool goes_on(const task_row& x) {
  return x.state == task_state::running || x.state == task_state::degraded;
}

task_file request_of(const node_client& node, const std::string& task) {
  const auto known =
      node.ask(message_json(task_revisions_query{task}), query_limit)
          .get<task_revisions>();
  task_file result;
  result.document = json::parse(known.revisions.back().request, nullptr, false);
  if (!result.document.is_object())
    throw command_error{exit_refused, "the request of task '" + printable(task)
                                          + "' cannot be read any more"};
  return result;
}

task_file request_of_set(const node_client& node, const std::string& set) {
  const auto known =
      node.get("/v1/tasks/" + percent_encode(set)).get<task_description>();
  if (known.sets.empty())
    throw command_error{exit_refused, "the cell does not have the set '"
                                          + printable(set) + "' any more"};
  task_file result;
  result.document = json::parse(known.sets.front().request, nullptr, false);
  return result;
}

/// It stands there as a whole, or not at all.
void write_whole(const fs::path& file, const std::string& text) {
  auto beside = file;
  beside += ".new";
  std::error_code error;
  {
    std::ofstream out{beside, std::ios::binary | std::ios::trunc};
    out << text;
    out.close();
    if (!out)
      error = std::make_error_code(std::errc::io_error);
  }
  if (!error)
    fs::rename(beside, file, error);
  if (!error)
    return;
  std::error_code ignored;
  fs::remove(beside, ignored);
  throw command_error{exit_usage, "cannot write " + printable(file.string())
                                      + ": " + error.message()};
}

void pull_skills(const node_client& node, const fs::path& file,
                 cell_document& cell) {
  const auto folder = file.stem().string() + ".skills";
  std::error_code error;
  for (auto& x : cell.skills) {
    const auto name =
        x.operation + "-" + x.build.substr(0, limits::build::shown_digits);
    x.source = (fs::path{folder} / name).string();
    const auto to = file.parent_path() / folder / name;
    if (fs::exists(to, error))
      continue;
    fs::create_directories(to.parent_path(), error);
    if (error)
      throw command_error{exit_usage, "cannot make "
                                          + printable(to.parent_path().string())
                                          + ": " + error.message()};
    pull_from_cell(node, x.operation, x.build, to, false);
    print_note("skill '" + printable(x.operation) + "' is in "
               + printable(to.string()));
  }
}

} // namespace

cell_document document_of_cell(const node_client& node) {
  const auto known = look_at_cell(node);
  cell_document result;
  result.cell = known.cell.cell;
  for (const auto& x : known.cell.nodes)
    if (x.identity.name != known.cell.coordinator)
      result.nodes.push_back(x.identity.name);
  for (const auto& x : known.skills.builds)
    result.skills.push_back({x.skill.descriptor.operation, x.build.hash, ""});
  for (const auto& x : known.cell.tasks)
    if (goes_on(x) && x.set.empty())
      result.tasks.push_back(request_of(node, x.task));
  for (const auto& x : known.sets)
    result.tasks.push_back(request_of_set(node, x.task));
  return result;
}

void export_cell(const node_client& node, const std::string& file,
                 bool with_skills) {
  auto cell = document_of_cell(node);
  if (file == "-")
    return print(pretty(document_of(cell)));
  if (with_skills)
    pull_skills(node, file, cell);
  write_whole(file, pretty(document_of(cell)));
}

} // namespace roscell::cli
