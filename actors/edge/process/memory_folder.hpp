#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// Where this user may make files that no disk ever has: /run for root, for
/// others what systemd names in $RUNTIME_DIRECTORY and $XDG_RUNTIME_DIR, then
/// /dev/shm.
std::vector<std::filesystem::path> memory_places();

/// Whether what is at that path lies in memory, and nowhere else.
bool is_in_memory(const std::filesystem::path& path);

/// Files in memory that single programs are given, in a folder for each. All of
/// it blocks, for a moment.
class memory_folder {
public:
  /// @param places where it may be, the best first.
  /// @param name its own there, which nobody else on this host uses.
  memory_folder(std::vector<std::filesystem::path> places, std::string name);

  using file_list = std::vector<std::pair<std::string, std::string>>;

  /// The folder for one program, anew, with these files, which nobody but
  /// `user` can read, and he can only read; empty: the user of this process.
  /// Errors: internal (no place in memory, no room, no such user).
  edge_result<std::filesystem::path> lay_out(const std::string& program,
                                             const file_list& files,
                                             const std::string& user) const;

  /// Removes the folder of one program, in whichever place.
  void clear(const std::string& program) const;

  /// Removes all folders but those of these programs.
  void clear_others(const std::set<std::string>& programs) const;

private:
  std::vector<std::filesystem::path> places_;
  std::string name_;
};

} // namespace roscell
