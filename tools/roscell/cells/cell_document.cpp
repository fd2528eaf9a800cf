#include "tools/roscell/cells/cell_document.hpp"

#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <filesystem>
#include <set>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

[[noreturn]] void refuse(const task_file& file, const std::string& what,
                         const std::string& where) {
  throw wrong_document{file, {error_code::schema_violation, what, where}};
}

/// Each name once, in a list of the document.
void check_once(const task_file& file, const char* list, const char* member) {
  std::set<std::string> seen;
  const auto all = file.document.value(list, json::array());
  for (size_t i = 0; i < all.size(); ++i) {
    const auto& x = *member == '\0' ? all[i] : all[i].value(member, json{});
    const auto at = "/" + std::string{list} + "/" + std::to_string(i)
                    + (*member == '\0' ? "" : "/" + std::string{member});
    if (x.is_string() && !seen.insert(x.get<std::string>()).second)
      refuse(file, "expected a name that is not in the list already", at);
  }
}

/// A task of the document, whose places are those of the file.
task_file task_in(const task_file& file, size_t i) {
  task_file result = file;
  result.document = file.document.at("tasks").at(i);
  result.document_at = file.document_at + "/tasks/" + std::to_string(i);
  if (auto why = validate_request(result.request()))
    throw wrong_document{result, std::move(*why)};
  return result;
}

std::filesystem::path folder_of(const std::string& file) {
  return file == "-" ? "." : std::filesystem::path{file}.parent_path();
}

cell_document decoded(const task_file& file) {
  const auto& document = file.document;
  cell_document result;
  result.file = file;
  result.cell = document.value("cell", "");
  result.nodes = document.value("nodes", std::vector<std::string>{});
  for (const auto& x : document.value("skills", json::array())) {
    wanted_skill skill{x.value("operation", ""), x.value("build", ""),
                       x.value("source", "")};
    if (!skill.source.empty())
      skill.source = (folder_of(file.name) / skill.source).string();
    result.skills.push_back(std::move(skill));
  }
  for (size_t i = 0; i < document.value("tasks", json::array()).size(); ++i)
    result.tasks.push_back(task_in(file, i));
  return result;
}

} // namespace

cell_document read_cell_document(const std::string& name,
                                 const file_values& values) {
  const auto file = read_task_file(name, values);
  if (auto why = validate_document("cell_document", file.document))
    throw wrong_document{file, std::move(*why)};
  check_once(file, "nodes", "");
  check_once(file, "skills", "build");
  check_once(file, "tasks", "task");
  return decoded(file);
}

json document_of(const cell_document& cell) {
  json result{{"kind", "cell"}, {"cell", cell.cell}, {"nodes", cell.nodes}};
  result["skills"] = json::array();
  for (const auto& x : cell.skills) {
    auto& skill = result["skills"].emplace_back(
        json{{"operation", x.operation}, {"build", x.build}});
    if (!x.source.empty())
      skill["source"] = x.source;
  }
  result["tasks"] = json::array();
  for (const auto& x : cell.tasks) {
    auto request = x.document;
    request.erase("type");
    result["tasks"].push_back(std::move(request));
  }
  return result;
}

} // namespace roscell::cli
