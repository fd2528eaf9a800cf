#pragma once

#include "actors/edge/cgroup/cgroup_tables.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// A folder in one hierarchy, in which this node makes a cgroup for each
/// instance.
struct cgroup_parent {
  std::filesystem::path folder;
  /// What works there. Of version 2 also without any a cgroup can be ended as
  /// one and tells what CPU it has used.
  std::set<std::string> controllers;
};

/// Where this node puts its process instances.
struct cgroup_place {
  int version = 0; ///< Of cgroups; 0: nowhere.
  std::vector<cgroup_parent> parents;
  std::string text; ///< What it is, or why there is none, for people.

  bool has(const std::string& controller) const;
};

struct cgroup_request {
  /// A folder of the cgroup file system, "auto" or "none".
  std::string where = "auto";
  std::string node_uuid; ///< Names the node's folder there.
  bool root = false;     ///< The node may write where it wants.
};

/// What this process sees.
struct cgroup_sight {
  std::vector<cgroup_mount> mounts;
  std::vector<cgroup_membership> own;
};

/// The hierarchy of version 2; null: there is none.
const cgroup_mount* unified_of(const cgroup_sight& sight);

/// Where there are both, version 1 is what limits.
bool has_version_1(const cgroup_sight& sight);

/// What /proc says of the calling process.
cgroup_sight see_cgroups();

/// The folders in which one may be made for the node, the best first: one list
/// of alternatives, each a folder in one or several hierarchies. Pure.
std::vector<std::vector<cgroup_parent>>
places_to_try(const cgroup_request& request, const cgroup_sight& sight);

/// Makes the folder of a parent, which is one of a node. False: it cannot.
bool make_parent(const cgroup_parent& parent);

/// Removes the node's folder where no instance is in it.
void remove_place(const cgroup_place& place);

/// Makes the node's folder in the first place where it can, and turns on there
/// what limits instances; empty folders of other nodes go. Fails never: the
/// text says why there is none.
cgroup_place find_cgroup_place(const cgroup_request& request,
                               const cgroup_sight& sight);

} // namespace roscell
