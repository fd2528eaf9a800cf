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

/// Where a build leaves the version of its sources.
constexpr const char* version_name = "skill.version";

/// The descriptor, or what is wrong with it.
std::variant<skill_descriptor, std::vector<schema_error>>
read_descriptor(const std::string& text) {
  auto document = parse_document(text);
  if (const auto* why = std::get_if<failure>(&document))
    return std::vector<schema_error>{{why->where, why->message}};
  const auto& content = std::get<json>(document);
  auto errors =
      document_errors("skill_descriptor", content, unknown_members::refused);
  if (!errors.empty())
    return errors;
  try {
    return content.get<skill_descriptor>();
  } catch (const std::exception& error) {
    return std::vector<schema_error>{{"", error.what()}};
  }
}

std::string sentence(const edge_error& why) {
  return why.hint.empty() ? why.message : why.message + " (" + why.hint + ")";
}

/// A version as schemas/common.schema.json has it.
bool is_version(const std::string& text) {
  constexpr size_t max_bytes = 64;
  return !text.empty() && text.size() <= max_bytes
         && std::all_of(text.begin(), text.end(),
                        [](char c) { return c >= '!' && c <= '~'; });
}

std::string version_of(const fs::path& folder, const installed_skill& skill) {
  constexpr size_t max_file_bytes = 256;
  if (!skill.descriptor.version.empty())
    return skill.descriptor.version;
  auto text = read_small_file(folder / version_name, max_file_bytes)
                  .value_or(std::string{});
  text.erase(std::min(text.find('\n'), text.size()));
  return is_version(text) ? text : skill.hash;
}

} // namespace

skill_catalogue skill_catalogue::scan(const std::vector<fs::path>& dirs,
                                      const std::string& host) {
  skill_catalogue result;
  result.host_ = host;
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
  add_build(path, std::get<skill_descriptor>(std::move(descriptor)));
}

void skill_catalogue::add_build(const fs::path& path,
                                skill_descriptor descriptor) {
  const auto program = find_program(path, descriptor.entry_point);
  if (const auto* why = std::get_if<edge_error>(&program))
    return blame(path / descriptor_name, sentence(*why), "/entry_point/0");
  const auto made_for = architecture_of_program(std::get<fs::path>(program));
  if (!runs_on(made_for, host_))
    return blame(path,
                 "is built for " + made_for + ", and this node is " + host_);
  // Looked at first: what is edited while it is hashed looks otherwise later.
  const auto look = look_at_folder(path);
  const auto hash = hash_folder(path);
  for (const auto* why :
       {std::get_if<edge_error>(&look), std::get_if<edge_error>(&hash)})
    if (why != nullptr)
      return blame(path, why->message);
  installed_skill skill{std::get<std::string>(hash), std::move(descriptor)};
  skill.version = version_of(path, skill);
  if (!made_for.empty())
    skill.architectures = {made_for};
  skill.added_unix_ms = std::get<folder_look>(look).changed_unix_ms;
  // Of two equal folders the first is as good as the other.
  skills_.emplace(skill.hash,
                  skill_folder{path, std::get<folder_look>(look).state, skill});
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

std::vector<skill_problem> skill_catalogue::told_problems() const {
  std::vector<skill_problem> result;
  for (size_t i = 0;
       i < std::min(problems_.size(), limits::skill::told_problems); ++i) {
    auto x = problems_[i];
    for (auto* text : {&x.path, &x.where, &x.message})
      *text = valid_utf8(text->substr(0, limits::skill::told_text_bytes));
    result.push_back(std::move(x));
  }
  return result;
}

void skill_catalogue::tell_problems(const house& context) const {
  for (const auto& x : problems_)
    context.tell("skill_refused", x.path,
                 {{"where", x.where}, {"message", x.message}});
}

} // namespace roscell
