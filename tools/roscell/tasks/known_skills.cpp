#include "tools/roscell/tasks/known_skills.hpp"

#include "actors/instances/skills/skill_catalogue.hpp"
#include "schemas/text_excerpt.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <set>
#include <string_view>

namespace roscell::cli {

namespace {

skill_list skills_in(const std::vector<std::string>& folders) {
  const auto found = skill_catalogue::scan({folders.begin(), folders.end()});
  skill_list result;
  for (const auto& skill : found.skills())
    result.skills.push_back({skill, {"here"}, {skill.added_unix_ms}});
  for (const auto& problem : found.problems())
    result.refused.push_back({"here", problem});
  if (result.skills.empty())
    throw command_error{exit_usage, "no skill is in " + joined(folders, ", "),
                        result.refused.empty()
                            ? "--skills takes a folder of skill folders, such "
                              "as build/release/skills"
                            : result.refused.front().problem.path + ": "
                                  + result.refused.front().problem.message};
  return result;
}

} // namespace

void add_skill_source(CLI::App& command, skill_source& source) {
  command
      .add_option("--skills", source.folders,
                  "Look for skills in the folders of this directory instead of "
                  "asking a node; can be repeated")
      ->option_text("DIR")
      ->allow_extra_args(false);
  add_connection_options(command, source.connection);
}

skill_list find_skills(const skill_source& source) {
  if (!source.folders.empty())
    return skills_in(source.folders);
  return node_client{source.connection}.get("/v1/skills").get<skill_list>();
}

std::vector<skill_row> rows_of(const skill_list& skills,
                               const std::string& operation) {
  std::vector<skill_row> result;
  std::set<std::string> known;
  for (const auto& row : skills.skills) {
    known.insert(row.skill.descriptor.operation);
    if (row.skill.descriptor.operation == operation)
      result.push_back(row);
  }
  if (!result.empty())
    return result;
  const auto meant = closest_word(operation, {known.begin(), known.end()});
  throw command_error{
      exit_refused, "no skill does '" + printable(operation) + "'",
      meant.empty()
          ? "the operations are: " + joined({known.begin(), known.end()}, ", ")
          : "did you mean '" + std::string{meant} + "'?"};
}

} // namespace roscell::cli
