#include "actors/instances/skills/skill_descriptor_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/instances/limits.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <exception>
#include <string>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

using errors = std::vector<schema_error>;

/// The first of them, each with its place in the text.
errors located(errors all, const std::string& text, document_format format) {
  if (all.size() > limits::skill::errors)
    all.resize(limits::skill::errors);
  for (auto& x : all)
    if (const auto at = find_place(text, format, x.pointer))
      x.expected = "line " + std::to_string(at->line) + ", column "
                   + std::to_string(at->column) + ": " + x.expected;
  return all;
}

} // namespace

std::vector<fs::path> descriptor_files(const fs::path& folder) {
  std::vector<fs::path> result;
  for (const auto* name : {"skill.json", "skill.yaml", "skill.yml"}) {
    std::error_code ignored;
    if (fs::exists(folder / name, ignored))
      result.push_back(folder / name);
  }
  return result;
}

fs::path descriptor_of(const fs::path& folder) {
  const auto files = descriptor_files(folder);
  return files.empty() ? folder / "skill.json" : files.front();
}

std::vector<std::string> entry_point_in(const fs::path& file) {
  const auto text = read_small_file(file, limits::skill::descriptor_bytes);
  if (!text)
    return {};
  const auto parsed = parse_document(*text, format_of(file.native(), *text));
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || !document->is_object()
      || document->contains("ros2") || !document->contains("entry_point"))
    return {};
  const json content{{"entry_point", document->at("entry_point")}};
  for (const auto& x :
       document_errors("skill_descriptor", content, unknown_members::refused))
    if (x.pointer.rfind("/entry_point", 0) == 0)
      return {};
  return content.at("entry_point").get<std::vector<std::string>>();
}

std::variant<skill_descriptor, errors> read_descriptor(const fs::path& file) {
  const auto text = read_small_file(file, limits::skill::descriptor_bytes);
  if (!text)
    return errors{{"", "cannot be read, or is longer than 1 MiB"}};
  return parse_descriptor(*text, format_of(file.native(), *text));
}

std::variant<skill_descriptor, errors>
parse_descriptor(const std::string& text, document_format format) {
  auto document = parse_document(text, format);
  if (const auto* why = std::get_if<failure>(&document))
    return errors{{why->where, why->message}};
  const auto& content = std::get<json>(document);
  auto wrong =
      document_errors("skill_descriptor", content, unknown_members::refused);
  if (!wrong.empty())
    return located(std::move(wrong), text, format);
  try {
    return content.get<skill_descriptor>();
  } catch (const std::exception& error) {
    return errors{{"", error.what()}};
  }
}

} // namespace roscell
