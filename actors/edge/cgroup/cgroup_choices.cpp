#include "actors/edge/cgroup/cgroup_place.hpp"

#include <algorithm>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// What the package prepares for the user that its units run as: of version 2
/// below the slice of these units, of version 1 in each hierarchy.
constexpr const char* prepared_unified = "roscell.slice/instances";
constexpr const char* prepared_v1 = "roscell-instances";

/// What root makes in version 2, where no unit is: what systemd ends or makes
/// anew must not take instances along.
constexpr const char* made_by_root = "roscell";

using place = std::vector<cgroup_parent>;

/// `rest` in every hierarchy of version 1.
place in_each(const cgroup_sight& sight, const fs::path& rest) {
  place result;
  for (const auto& x : sight.mounts)
    if (!x.unified)
      result.push_back({x.point / rest, x.controllers});
  return result;
}

/// Beside the node in every hierarchy of version 1, which nothing forbids
/// there: what bounds the node bounds what it runs.
place beside_in_each(const cgroup_sight& sight) {
  place result;
  for (const auto& x : sight.mounts) {
    const auto* own = x.unified ? nullptr : member_of(x, sight.own);
    if (const auto folder =
            own != nullptr ? folder_of(x, own->path) : std::nullopt)
      result.push_back({*folder, x.controllers});
  }
  return result;
}

/// What the user has named, in each hierarchy.
fs::path rest_of(const std::string& where) {
  constexpr std::string_view usual = "/sys/fs/cgroup/";
  return where.rfind(usual, 0) == 0 ? fs::path{where.substr(usual.size())}
                                    : fs::path{where}.relative_path();
}

void add_unified(const cgroup_mount& x, const cgroup_sight& sight,
                 const cgroup_request& request, std::vector<place>& result) {
  result.push_back({{x.point / prepared_unified, {}}});
  if (request.root)
    result.push_back({{x.point / made_by_root, {}}});
  const auto* own = member_of(x, sight.own);
  const auto folder = own != nullptr ? folder_of(x, own->path) : std::nullopt;
  if (!folder)
    return;
  // Below the node itself nothing can be limited: it is a process there.
  if (*folder != x.point)
    result.push_back({{folder->parent_path(), {}}});
  result.push_back({{*folder, {}}});
}

} // namespace

const cgroup_mount* unified_of(const cgroup_sight& sight) {
  const auto found = std::find_if(sight.mounts.begin(), sight.mounts.end(),
                                  [](const auto& x) { return x.unified; });
  return found != sight.mounts.end() ? &*found : nullptr;
}

bool has_version_1(const cgroup_sight& sight) {
  return std::any_of(sight.mounts.begin(), sight.mounts.end(),
                     [](const auto& x) { return !x.unified; });
}

std::vector<place> places_to_try(const cgroup_request& request,
                                 const cgroup_sight& sight) {
  std::vector<place> result;
  const auto v1 = has_version_1(sight);
  const auto* unified = unified_of(sight);
  if (request.where == "none")
    return {};
  if (request.where != "auto") {
    if (v1)
      result.push_back(in_each(sight, rest_of(request.where)));
    else if (unified != nullptr)
      result.push_back({{request.where, {}}});
    return result;
  }
  // A host that has both uses version 1 for what limits.
  if (v1) {
    result.push_back(in_each(sight, prepared_v1));
    result.push_back(beside_in_each(sight));
  } else if (unified != nullptr) {
    add_unified(*unified, sight, request, result);
  }
  return result;
}

} // namespace roscell
