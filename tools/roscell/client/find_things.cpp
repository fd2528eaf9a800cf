#include "tools/roscell/client/find_things.hpp"

#include "schemas/text_excerpt.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

template <class Row, class Predicate>
std::vector<Row> those(const std::vector<Row>& all, Predicate&& is_meant) {
  std::vector<Row> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result), is_meant);
  return result;
}

bool begins_with(const std::string& text, const std::string& word) {
  return !word.empty() && text.compare(0, word.size(), word) == 0;
}

/// The names of rows, each once and in order.
template <class Row, class Name>
std::vector<std::string> names_of_rows(const std::vector<Row>& rows,
                                       Name&& name) {
  std::set<std::string> result;
  for (const auto& x : rows)
    result.insert(name(x));
  return {result.begin(), result.end()};
}

/// The rows of the instance of that id, else those of the task of that name,
/// else those of the only instance whose id begins so.
/// @param several what is said of several that begin so.
template <class Row, class Id, class Task>
std::vector<Row> rows_of_word(const std::vector<Row>& known,
                              const std::string& word, Id&& id, Task&& task,
                              const char* several) {
  auto found = those(known, [&](const Row& x) { return id(x) == word; });
  if (found.empty())
    found = those(known, [&](const Row& x) { return task(x) == word; });
  if (!found.empty())
    return found;
  found = those(known, [&](const Row& x) { return begins_with(id(x), word); });
  const auto ids = names_of_rows(found, id);
  if (ids.size() > 1)
    throw command_error{exit_usage, several + (" '" + word + "'"),
                        joined(ids, ", ")};
  return found;
}

[[noreturn]] void refuse_ambiguous(const std::vector<known_thing>& found,
                                   const std::string& name) {
  const auto words = names_of_rows(
      found, [](const auto& x) { return to_string(x.kind) + " " + x.name; });
  if (words.size() == 1)
    throw command_error{exit_usage, "several nodes are called '" + name + "'",
                        "`roscell nodes` shows their addresses; start one of "
                        "them with another --name"};
  throw command_error{exit_usage, "several things are called '" + name + "'",
                      "say which one: " + joined(words, ", ")};
}

/// "did you mean 'arm-1'?"; empty where nothing is near.
std::string near_text(const std::string& word,
                      const std::vector<std::string_view>& names) {
  const std::string near{closest_word(word, names)};
  return near.empty() ? "" : "did you mean '" + near + "'?";
}

} // namespace

known_thing find_thing(const known_cell& known, const std::string& kind,
                       const std::string& name) {
  const auto all = those(things_of(known), [&](const auto& x) {
    return kind.empty() || to_string(x.kind) == kind;
  });
  auto found = those(all, [&](const auto& x) { return x.name == name; });
  if (found.empty())
    found = those(all, [&](const auto& x) {
      return x.kind == thing_kind::instance && begins_with(x.name, name);
    });
  if (found.size() > 1)
    refuse_ambiguous(found, name);
  if (!found.empty())
    return found.front();
  std::vector<std::string_view> names;
  names.reserve(all.size());
  for (const auto& x : all)
    names.push_back(x.name);
  throw command_error{
      exit_refused,
      "there is no "
          + (kind.empty() ? "node, task, instance, skill or cell" : kind) + " '"
          + name + "'",
      near_text(name, names)};
}

std::vector<instance_row> find_instances(const std::vector<instance_row>& known,
                                         const std::string& word) {
  auto found = rows_of_word(
      known, word, [](const auto& x) { return x.spec.instance; },
      [](const auto& x) { return x.spec.task; },
      "several instances begin with");
  if (!found.empty())
    return found;
  std::vector<std::string_view> names;
  for (const auto& row : known) {
    names.push_back(row.spec.instance);
    names.push_back(row.spec.task);
  }
  const auto near = near_text(word, names);
  throw command_error{exit_refused,
                      "no instance and no task '" + word + "' is known",
                      (near.empty() ? "" : near + " ")
                          + std::string{"`roscell instances` lists them"}};
}

std::vector<kept_log> find_kept_logs(const std::vector<kept_log>& known,
                                     const std::string& word) {
  auto found = rows_of_word(
      known, word, [](const auto& x) { return x.instance; },
      [](const auto& x) { return x.task; },
      "several kept logs are of instances that begin with");
  const bool is_task =
      !found.empty() && found.front().task == word
      && std::none_of(found.begin(), found.end(),
                      [&](const auto& x) { return x.instance == word; });
  const auto step_or_id = [is_task](const kept_log& x) {
    return is_task ? x.step : x.instance;
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const kept_log& x, const kept_log& y) {
                     return step_or_id(x) < step_or_id(y);
                   });
  // The newest of each is the first.
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const kept_log& x, const kept_log& y) {
                            return step_or_id(x) == step_or_id(y);
                          }),
              found.end());
  return found;
}

std::string kept_log_text(const kept_log& log, int64_t now_unix_ms) {
  auto result = printable(log.instance) + " on node " + printable(log.node)
                + ": " + std::string{to_string(log.state)};
  if (log.ended_unix_ms > 0)
    result += ' ' + format_since(log.ended_unix_ms, now_unix_ms) + " ago";
  if (log.exit_code >= 0)
    result += ", exit code " + std::to_string(log.exit_code);
  return log.reason.empty() ? result
                            : result + " (" + printable(log.reason) + ")";
}

known_cell ask_for_cell(const node_client& node) {
  known_cell result;
  result.asked = node.get("/v1/node").get<node_description>();
  result.cell = result.asked.role == node_role::coordinator
                    ? node.get("/v1/cell").get<cell_description>()
                    : cell_around(result.asked);
  result.instances =
      node.get("/v1/instances").get<instance_description>().instances;
  result.skills = node.get("/v1/skills").get<skill_list>();
  result.events = kept_events_of(node);
  return result;
}

std::vector<instance_row> instances_in_cell(const node_client& node) {
  std::vector<instance_row> result;
  try {
    const auto known = node.get("/v1/tasks").get<task_description>();
    for (const auto& task : known.tasks)
      result.insert(result.end(), task.instances.begin(), task.instances.end());
  } catch (const refused&) {
    // A node in no cell has told all that it knows.
  }
  return result;
}

bool add_cell_of_member(const node_client& node, known_cell& known) {
  if (known.asked.role == node_role::coordinator || known.asked.cell.empty())
    return false;
  try {
    known.cell = node.get("/v1/cell").get<cell_description>();
  } catch (const refused&) {
    return false;
  }
  for (auto& row : instances_in_cell(node))
    if (std::none_of(known.instances.begin(), known.instances.end(),
                     [&](const auto& x) {
                       return x.spec.instance == row.spec.instance;
                     }))
      known.instances.push_back(std::move(row));
  return true;
}

} // namespace roscell::cli
