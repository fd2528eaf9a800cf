#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/instances/skills/skill_program.hpp"
#include "messages/skill.hpp"
#include "schemas/validator.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// A skill that this node can run.
struct skill_folder {
  std::filesystem::path path; ///< Absolute, without links.
  std::string look;           ///< When it was hashed: see folder_fingerprint.
  installed_skill skill;
  /// Its instances are actors of this process; there is no folder.
  bool in_process = false;
};

/// It stays as it is for whoever runs it, whatever becomes of its folder.
using shared_skill_folder = std::shared_ptr<const skill_folder>;

/// The skills of a node, by content hash. Filled once and then only read, so
/// that actors can share it.
class skill_catalogue {
public:
  /// Reads every sub-folder with a descriptor. A bad one is left out, and the
  /// others stay: one whose program cannot run on `host`, too. Blocks on the
  /// disk: not for a scheduled actor.
  static skill_catalogue scan(const std::vector<std::filesystem::path>& dirs,
                              const skill_host& host = {own_architecture()});

  /// What is in these directories by now, and the skills of this process. A
  /// folder that looks as it did is not read again. Unless it is quiet, one
  /// that was just written to stays what it was, and what is wrong since then
  /// is not said yet: somebody may be copying it.
  skill_catalogue scan_again(const std::vector<std::filesystem::path>& dirs,
                             bool is_quiet) const;

  /// Adds a skill whose instances are actors of this process, by the text of
  /// its descriptor. What is wrong with it, or nothing.
  std::vector<schema_error> add_actor_skill(const std::string& descriptor);

  /// The same for one folder, which is said to be no skill if it has no
  /// descriptor.
  static skill_catalogue of_folder(const std::filesystem::path& folder,
                                   const skill_host& host);

  /// Null if there is none with that hash.
  shared_skill_folder find(const std::string& hash) const;

  /// In the order of their hashes.
  std::vector<installed_skill> skills() const;

  const std::vector<skill_problem>& problems() const {
    return problems_;
  }

  /// The first of them, short enough for a message.
  std::vector<skill_problem> published_problems() const;

  /// Records an event for every problem that `before` had not.
  void publish_problems(const actor_context& context,
                        const skill_catalogue& before) const;

private:
  void scan_directory(const std::filesystem::path& directory);
  void add_folder(const std::filesystem::path& folder);
  bool blame_program(const std::filesystem::path& path,
                     const checked_program& program);
  void add_build(const std::filesystem::path& path,
                 skill_descriptor descriptor);
  void add_content(const std::filesystem::path& path, installed_skill skill);
  bool leave_as_before(const std::filesystem::path& path);
  void drop_new_problems();
  void keep(const shared_skill_folder& folder);
  void blame(const std::filesystem::path& path, const std::string& message,
             std::string where = {});

  skill_host host_;
  /// While folders are scanned again: what was known of them, and from when on
  /// a change is too new to be looked at.
  const skill_catalogue* before_ = nullptr;
  int64_t too_new_unix_ms_ = std::numeric_limits<int64_t>::max();
  std::map<std::string, shared_skill_folder> skills_;
  /// All that are skills, those of equal content too.
  std::map<std::filesystem::path, shared_skill_folder> folders_;
  std::vector<skill_problem> problems_;
};

using shared_skill_catalogue = std::shared_ptr<const skill_catalogue>;

} // namespace roscell
