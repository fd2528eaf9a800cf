#include "actors/edge/cgroup/cgroup_place.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <thread>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_mount_bytes = 4 * 1024 * 1024;
constexpr size_t most_membership_bytes = 256 * 1024;
constexpr size_t most_controller_bytes = 4096;

/// What limits an instance in version 2.
constexpr std::array<const char*, 3> limiting{"memory", "cpu", "pids"};

std::string read_words(const fs::path& file) {
  return read_small_file(file, most_controller_bytes).value_or("");
}

std::set<std::string> words_in(const std::string& text) {
  std::istringstream words{text};
  std::set<std::string> result;
  for (std::string word; words >> word && result.size() < 64;)
    result.insert(word);
  return result;
}

bool write_word(const fs::path& file, const std::string& word) {
  const unique_fd to{::open(file.c_str(), O_WRONLY | O_CLOEXEC)};
  return to && write_whole(to.get(), word);
}

/// Has the children of a cgroup of version 2 limited as far as can be.
void enable(const fs::path& folder) {
  const auto file = folder / "cgroup.subtree_control";
  const auto before = words_in(read_words(file));
  // One at a time: one that cannot be must not take the others along.
  for (const auto* x : limiting)
    if (before.count(x) == 0)
      write_word(file, std::string{"+"} + x);
}

constexpr const char* node_prefix = "node-";

bool make_folder(const fs::path& folder) {
  return ::mkdir(folder.c_str(), 0755) == 0 || errno == EEXIST;
}

/// Those of nodes that were killed; one that is in use stays.
void remove_siblings(const fs::path& own) {
  std::error_code error;
  for (fs::directory_iterator i{own.parent_path(), error}, end;
       !error && i != end; i.increment(error))
    if (i->path() != own
        && i->path().filename().native().rfind(node_prefix, 0) == 0)
      ::rmdir(i->path().c_str());
}

/// Where a process comes from and where it goes must have an ancestor that its
/// user may write, or it may not go there.
bool may_enter(const fs::path& folder, const cgroup_sight& sight) {
  const auto* mount = unified_of(sight);
  const auto* own = mount ? member_of(*mount, sight.own) : nullptr;
  const auto here =
      own != nullptr ? folder_of(*mount, own->path) : std::nullopt;
  if (!here)
    return false;
  fs::path common;
  for (auto i = here->begin(), j = folder.begin();
       i != here->end() && j != folder.end() && *i == *j; ++i, ++j)
    common /= *i;
  return ::access((common / "cgroup.procs").c_str(), W_OK) == 0;
}

/// The same place, as it works; nothing with errno set where it does not.
std::optional<cgroup_parent> ready(const cgroup_parent& request,
                                   const cgroup_request& about,
                                   const cgroup_sight& sight, bool unified) {
  cgroup_parent result{request.folder / (node_prefix + about.node_uuid),
                       request.controllers};
  // Only root makes the place itself.
  if (about.root && unified)
    make_folder(request.folder);
  if (unified && !may_enter(request.folder, sight))
    return std::nullopt;
  if (!make_parent(result) || ::access(result.folder.c_str(), W_OK) != 0)
    return std::nullopt;
  remove_siblings(result.folder);
  if (unified)
    result.controllers =
        words_in(read_words(result.folder / "cgroup.subtree_control"));
  return result;
}

std::string list(const std::set<std::string>& words) {
  std::string result;
  for (const auto& x : words)
    result += (result.empty() ? "" : ", ") + x;
  return result;
}

cgroup_place none(const std::string& why) {
  return {0, {}, "none: " + why};
}

void say_what_it_is(cgroup_place& x) {
  std::set<std::string> all;
  for (const auto& parent : x.parents)
    all.insert(parent.controllers.begin(), parent.controllers.end());
  x.text = "cgroup v" + std::to_string(x.version) + " in "
           + x.parents.front().folder.string() + ": "
           + (all.empty() ? "nothing is bounded" : list(all));
  if (!x.has("memory") && !all.empty())
    x.text += ", but not memory";
}

/// The hierarchies of one place that can be written.
cgroup_place made(const std::vector<cgroup_parent>& request,
                  const cgroup_request& about, const cgroup_sight& sight,
                  bool unified, std::string& why) {
  cgroup_place result;
  for (const auto& x : request)
    if (auto parent = ready(x, about, sight, unified))
      result.parents.push_back(std::move(*parent));
    else if (why.empty())
      why =
          "'" + x.folder.string() + "' cannot be used: " + std::strerror(errno);
  if (result.parents.empty())
    return {};
  result.version = unified ? 2 : 1;
  say_what_it_is(result);
  return result;
}

} // namespace

bool cgroup_place::has(const std::string& controller) const {
  return std::any_of(parents.begin(), parents.end(), [&](const auto& x) {
    return x.controllers.count(controller) != 0;
  });
}

bool make_parent(const cgroup_parent& parent) {
  if (!make_folder(parent.folder))
    return false;
  // Of version 2 only: in version 1 there is no such file.
  enable(parent.folder.parent_path());
  enable(parent.folder);
  // Of version 1, where it lies among single programs, each of which has 1024:
  // all instances together are worth as many as the host has cores.
  if (parent.controllers.count("cpu") != 0)
    write_word(parent.folder / "cpu.shares",
               std::to_string(
                   1024 * std::max(1U, std::thread::hardware_concurrency())));
  return true;
}

void remove_place(const cgroup_place& place) {
  for (const auto& x : place.parents)
    ::rmdir(x.folder.c_str());
}

cgroup_sight see_cgroups() {
  return {
      cgroup_mounts_in(read_small_file("/proc/self/mountinfo", most_mount_bytes)
                           .value_or("")),
      cgroups_in(read_small_file("/proc/self/cgroup", most_membership_bytes)
                     .value_or(""))};
}

cgroup_place find_cgroup_place(const cgroup_request& request,
                               const cgroup_sight& sight) {
  if (request.where == "none")
    return none("it was told so");
  const auto all = places_to_try(request, sight);
  if (all.empty())
    return none("this host has no cgroups");
  std::string why;
  cgroup_place second;
  for (const auto& x : all) {
    auto result = made(x, request, sight, !has_version_1(sight), why);
    if (result.has("memory"))
      return result;
    if (second.version == 0)
      second = std::move(result);
  }
  return second.version != 0 ? second : none(why);
}

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
