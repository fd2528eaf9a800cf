#include "actors/instances/skills/skill_catalogue.hpp"

#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/instances/limits.hpp"
#include "actors/instances/skills/skill_descriptor_file.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Where a build leaves the version of its sources.
constexpr const char* version_name = "skill.version";

constexpr const char* actor_engine = "actor";

/// Marks the hash as that of an actor's descriptor.
constexpr std::string_view actor_key = "roscell actor skill";

std::string skill_problem_text(const edge_error& why) {
  return why.hint.empty() ? why.message : why.message + " (" + why.hint + ")";
}

/// Which of them is meant cannot be known.
std::string several_files_text(const std::vector<fs::path>& files) {
  std::string names;
  for (const auto& x : files)
    names += (names.empty() ? "" : " and ") + x.filename().string();
  return "holds " + names + "; a skill has one descriptor: remove the others";
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
                                      const skill_host& host) {
  skill_catalogue result;
  result.host_ = host;
  for (const auto& x : dirs)
    result.scan_directory(x);
  return result;
}

skill_catalogue skill_catalogue::of_folder(const fs::path& folder,
                                           const skill_host& host) {
  skill_catalogue result;
  result.host_ = host;
  result.add_folder(folder);
  return result;
}

void skill_catalogue::scan_directory(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator i{directory, error}, end; !error && i != end;
       i.increment(error)) {
    if (descriptor_files(i->path()).empty())
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
  if (error)
    return blame(folder, "cannot be read: " + error.message());
  if (path.native().size() > limits::skill::path_bytes)
    return blame(path, "has too long a path");
  if (leave_as_before(path))
    return;
  const auto files = descriptor_files(path);
  if (files.size() > 1)
    return blame(path, several_files_text(files));
  if (files.empty())
    return blame(path, "holds no skill.json, skill.yaml or skill.yml");
  const auto& file = files.front();
  auto descriptor = read_descriptor(file);
  if (const auto* errors =
          std::get_if<std::vector<schema_error>>(&descriptor)) {
    for (const auto& x : *errors)
      blame(file, x.expected, x.pointer);
    if (const auto program = entry_point_in(file); !program.empty())
      blame_program(path, check_program(path, program, {}, host_));
    return;
  }
  add_build(path, std::get<skill_descriptor>(std::move(descriptor)));
}

std::vector<schema_error>
skill_catalogue::add_actor_skill(const std::string& text) {
  auto parsed = parse_descriptor(text, format_of("", text));
  if (auto* errors = std::get_if<std::vector<schema_error>>(&parsed))
    return std::move(*errors);
  auto& descriptor = std::get<skill_descriptor>(parsed);
  if (descriptor.engine != actor_engine)
    return {{"/engine", "expected \"actor\": it is registered with a factory "
                        "for actors"}};
  for (const auto& [hash, x] : skills_)
    if (x->in_process && x->skill.descriptor.operation == descriptor.operation)
      return {{"/operation",
               "expected an operation that no other actor skill of "
               "this program has; one may have several models"}};
  installed_skill skill{to_hex(hmac_sha256(actor_key, text)),
                        std::move(descriptor)};
  if (skill.version.empty())
    skill.version = skill.hash;
  skill.architectures = {host_.architecture};
  skills_.emplace(skill.hash, std::make_shared<const skill_folder>(
                                  skill_folder{{}, {}, skill, true}));
  return {};
}

bool skill_catalogue::blame_program(const fs::path& path,
                                    const checked_program& program) {
  for (const auto& why : program.problems)
    blame(descriptor_of(path), skill_problem_text(why), "/entry_point/0");
  return !program.problems.empty();
}

void skill_catalogue::add_build(const fs::path& path,
                                skill_descriptor descriptor) {
  if (descriptor.engine == actor_engine)
    return blame(descriptor_of(path),
                 "a skill of the engine \"actor\" is no folder: the program "
                 "that embeds a node registers it",
                 "/engine");
  installed_skill skill;
  // A ROS 2 program is in the base image, or on the host.
  if (descriptor.ros2.empty()) {
    const auto program =
        check_program(path, descriptor.entry_point, descriptor.models, host_);
    if (blame_program(path, program))
      return;
    if (!program.made_for.empty())
      skill.architectures = {program.made_for};
  }
  skill.descriptor = std::move(descriptor);
  add_content(path, std::move(skill));
}

void skill_catalogue::add_content(const fs::path& path, installed_skill skill) {
  // Looked at first: what is edited while it is hashed looks otherwise later.
  const auto look = read_folder(path);
  const auto hash = hash_folder(path);
  for (const auto* why :
       {std::get_if<edge_error>(&look), std::get_if<edge_error>(&hash)})
    if (why != nullptr)
      return blame(path, why->message);
  skill.hash = std::get<std::string>(hash);
  skill.version = version_of(path, skill);
  skill.added_unix_ms = std::get<folder_fingerprint>(look).changed_unix_ms;
  keep(std::make_shared<const skill_folder>(skill_folder{
      path, std::get<folder_fingerprint>(look).state, std::move(skill)}));
}

void skill_catalogue::keep(const shared_skill_folder& folder) {
  folders_.emplace(folder->path, folder);
  // Of two equal folders the first is as good as the other.
  skills_.emplace(folder->skill.hash, folder);
}

void skill_catalogue::blame(const fs::path& path, const std::string& message,
                            std::string where) {
  // A file may have any name.
  problems_.push_back(
      {valid_utf8(path.string()), std::move(where), valid_utf8(message)});
}

shared_skill_folder skill_catalogue::find(const std::string& hash) const {
  const auto i = skills_.find(hash);
  return i == skills_.end() ? nullptr : i->second;
}

std::vector<installed_skill> skill_catalogue::skills() const {
  std::vector<installed_skill> result;
  for (const auto& [hash, x] : skills_)
    result.push_back(x->skill);
  return result;
}

} // namespace roscell
