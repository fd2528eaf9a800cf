#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/inside/runtime.hpp"
#include "messages/skill.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// The program that a skill folder's descriptor names. The folder can be edited
/// at any time, and what is in it then is another build than the one that was
/// chosen.
namespace roscell {

/// Where it is, if it is there and can be run. Errors: engine_failed.
edge_result<std::filesystem::path>
find_program(const std::filesystem::path& skill_dir,
             const std::vector<std::string>& entry_point);

/// What shall run skills.
struct skill_host {
  /// As container images name it.
  std::string architecture;
  /// Skills are processes of this host, with its C library and interpreters;
  /// in a container they have those of their image.
  bool runs_processes = false;
};

/// What is known of a skill's program before it ever runs.
struct checked_program {
  /// What it is compiled for, as container images name it; empty for a script,
  /// which runs where its interpreter does, and for unknown machines.
  std::string made_for;
  /// All that keeps it from running on a host.
  std::vector<edge_error> problems;
};

/// Looks at the program: whether it can be run, is for `host` and for what a
/// deployment of `models` is for, and, unless that is another machine than this
/// one, finds its interpreter and libraries; those not if a deployment says
/// where else they are.
/// Blocks on the disk, and on the dynamic linker for some milliseconds.
checked_program check_program(const std::filesystem::path& skill_dir,
                              const std::vector<std::string>& entry_point,
                              const std::vector<implementation_model>& models,
                              const skill_host& host);

/// Whether a program for `architecture` runs on a host of another one.
bool runs_on(const std::string& architecture, const std::string& host);

/// Of the host that this process runs on.
std::string own_architecture();

/// Whether the folder still holds the build that `request` names. Reads its
/// files only where it looks different than when it was hashed. Blocks on the
/// disk.
///
/// Errors: engine_failed (it was edited; it cannot be read).
edge_result<bool> check_build(const prepare_image& request);

} // namespace roscell
