#include "actors/instances/skill_catalogue.hpp"

#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/utf8.hpp"
#include "actors/house/limits.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <algorithm>
#include <exception>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr const char* descriptor_name = "skill.json";

/// The descriptor, or what is wrong with it.
std::variant<skill_descriptor, std::vector<schema_error>>
read_descriptor(const std::string& text) {
  auto document = parse_document(text);
  if (const auto* why = std::get_if<failure>(&document))
    return std::vector<schema_error>{{why->where, why->message}};
  const auto& content = std::get<json>(document);
  auto errors = document_errors("skill_descriptor", content);
  if (!errors.empty())
    return errors;
  try {
    return content.get<skill_descriptor>();
  } catch (const std::exception& error) {
    return std::vector<schema_error>{{"", error.what()}};
  }
}

} // namespace

skill_catalogue skill_catalogue::scan(const std::vector<fs::path>& dirs) {
  skill_catalogue result;
  for (const auto& x : dirs)
    result.scan_directory(x);
  return result;
}

void skill_catalogue::scan_directory(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator i{directory, error}, end; !error && i != end;
       i.increment(error)) {
    std::error_code ignored;
    if (!fs::exists(i->path() / descriptor_name, ignored))
      continue;
    if (folders.size() == limits::skill::most) {
      blame(directory, "holds more than " + std::to_string(limits::skill::most)
                           + " skills; the others are left out");
      break;
    }
    folders.push_back(i->path());
  }
  if (error)
    blame(directory, "cannot be read: " + error.message());
  // So that problems come in the same order every time.
  std::sort(folders.begin(), folders.end());
  for (const auto& x : folders)
    add_folder(x);
}

void skill_catalogue::add_folder(const fs::path& folder) {
  std::error_code error;
  const auto path = fs::canonical(folder, error);
  const auto file = path / descriptor_name;
  const auto text = read_small_file(file, limits::skill::descriptor_bytes);
  if (error || !text)
    return blame(folder / descriptor_name,
                 "cannot be read, or is longer than 1 MiB");
  if (path.native().size() > limits::skill::path_bytes)
    return blame(path, "has too long a path");
  auto descriptor = read_descriptor(*text);
  if (const auto* errors =
          std::get_if<std::vector<schema_error>>(&descriptor)) {
    for (size_t i = 0; i < std::min(errors->size(), limits::skill::errors); ++i)
      blame(file, (*errors)[i].expected, (*errors)[i].pointer);
    return;
  }
  const auto hash = hash_folder(path);
  if (const auto* why = std::get_if<edge_error>(&hash))
    return blame(path, why->message);
  const auto& digits = std::get<std::string>(hash);
  // Of two equal folders the first is as good as the other.
  skills_.emplace(
      digits,
      skill_folder{path, {digits, std::get<skill_descriptor>(descriptor)}});
}

void skill_catalogue::blame(const fs::path& path, const std::string& message,
                            std::string where) {
  // A file may have any name.
  problems_.push_back(
      {valid_utf8(path.string()), std::move(where), valid_utf8(message)});
}

const skill_folder* skill_catalogue::find(const std::string& hash) const {
  const auto i = skills_.find(hash);
  return i == skills_.end() ? nullptr : &i->second;
}

std::vector<installed_skill> skill_catalogue::skills() const {
  std::vector<installed_skill> result;
  for (const auto& [hash, x] : skills_)
    result.push_back(x.skill);
  return result;
}

void skill_catalogue::tell_problems(const house& context) const {
  for (const auto& x : problems_)
    context.tell("skill_refused", x.path,
                 {{"where", x.where}, {"message", x.message}});
}

} // namespace roscell
