#pragma once

#include "actors/edge/cgroup/cgroup_place.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// What an instance is held to.
struct instance_bounds {
  double memory_mib = 0; ///< 0: no bound.
  double cpu = 0;        ///< Cores: its share where others want them, too.
  /// It has a scheduling of its own, which version 1 may forbid in cgroups.
  bool real_time = false;
};

/// The cgroup of one process instance: a folder named after it in each
/// hierarchy of the node's place. Who is in it ends together.
class instance_cgroup {
public:
  /// None.
  instance_cgroup() = default;

  /// Makes the folders, anew where an earlier run has left them, and sets the
  /// bounds. What cannot be made is left out: the instance runs without.
  static instance_cgroup make(const cgroup_place& place,
                              const std::string& instance,
                              const instance_bounds& bounds);

  /// The one whose folders the instance's folder `records` names.
  static instance_cgroup recall(const std::filesystem::path& records);

  /// The one of that name in the place, as far as it is there.
  static instance_cgroup named(const cgroup_place& place,
                               const std::string& instance);

  /// Notes them there, where a later run of the node finds them.
  void record(const std::filesystem::path& records) const;

  const std::vector<std::filesystem::path>& folders() const {
    return folders_;
  }

  /// Kills all who are in it, and waits a moment for their end. Returns
  /// whether anybody was.
  bool kill() const;

  /// Removes it. False: somebody is in it, or it may not be removed.
  bool remove() const;

private:
  std::vector<std::filesystem::path> folders_;
};

/// Ends and removes what is left there of instances that are not `known`.
/// Returns what could not be removed.
std::vector<std::string>
remove_other_cgroups(const cgroup_place& place,
                     const std::set<std::string>& known);

/// The weight of so many cores among other cgroups: of version 2, where 100 is
/// usual, and the shares of version 1, where 1024 are.
long long cpu_weight_of(double cores);
long long cpu_shares_of(double cores);

// INTERNAL to this folder: one folder of a cgroup, of either version.

/// Writes a word into a file of it. False with errno set.
bool put_word(const std::filesystem::path& file, const std::string& word);

bool is_unified_cgroup(const std::filesystem::path& folder);

/// Kills who is there; of version 2 the cgroups below it are counted, and
/// ended, along with it. Returns whether anybody was.
bool kill_members_of(const std::filesystem::path& folder);

/// Removes it with what an instance has made in it. True also where it is gone;
/// one that somebody has just left can need a moment.
bool remove_cgroup(const std::filesystem::path& folder);

} // namespace roscell
