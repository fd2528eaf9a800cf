#pragma once

#include <filesystem>
#include <string>

/// INTERNAL to this folder: one folder of a cgroup, of either version.
namespace roscell {

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
