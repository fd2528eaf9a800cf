#pragma once

#include "actors/builds/build_records.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// The builds that a node has of its cell, in its data directory, by their
/// hashes. Nothing of a build can be executed, or is taken for a skill, before
/// all of it has been checked; what was written before a loss of power is found
/// again. All of it blocks on the disk.
///
///     FOLDER/kept/HASH       a whole build, of a skill or an image
///     FOLDER/skills/HASH     one that was used here since: a skill folder
///     FOLDER/unfinished/HASH one on its way
///     FOLDER/about           what is written of each: build_records
class build_store {
public:
  /// @param most_bytes of all builds together; what was not used for longest
  ///   goes when another one needs the room.
  /// @param runs_here whether the skill in a folder is for this host.
  build_store(std::filesystem::path folder, uint64_t most_bytes,
              std::function<bool(const std::filesystem::path&)> runs_here);

  /// Where the skills are, and builds that are none here.
  static std::filesystem::path skills_in(const std::filesystem::path& folder);
  static std::filesystem::path kept_in(const std::filesystem::path& folder);

  /// Makes room for a build and begins it, or goes on with it; nothing happens
  /// to one that is whole.
  /// Errors: schema_violation (the manifest), conflict (builds that are in use
  /// or pinned leave too little room), internal (the disk).
  edge_result<stored_build> offer(const build_name& name,
                                  const std::string& manifest,
                                  const std::string& cell,
                                  const std::set<std::string>& in_use,
                                  int64_t now_unix_ms);

  /// A build that lies whole in a folder of the same disk, which is gone
  /// afterwards, one way or the other. It is no skill, and what its files are
  /// is known to who brings it.
  /// Errors: as for `offer`.
  edge_result<stored_build>
  take(const std::filesystem::path& from, const build_name& name,
       const std::string& manifest, const std::string& cell,
       const std::set<std::string>& in_use, int64_t now_unix_ms);

  /// The last piece makes the build whole.
  /// Errors: schema_violation (other bytes), conflict (no such build is on its
  /// way; all pieces came and it is another build, which is dropped), internal.
  edge_result<stored_build> write(const std::string& hash, size_t piece,
                                  std::string_view bytes);

  /// Null: there is none.
  const stored_build* find(const std::string& hash) const;

  /// Errors: conflict (it is not here, or that piece is not), internal.
  edge_result<std::string> manifest_text(const std::string& hash) const;
  edge_result<std::string> read(const std::string& hash, size_t piece);

  /// @param cell of a build that has none yet.
  /// Errors: internal (the disk).
  std::optional<edge_error> pin(const std::string& hash, bool pinned,
                                const std::string& cell);
  /// Makes a skill of it. Errors: conflict (it is not here as a whole, or is
  /// for other hosts), internal (the disk).
  edge_result<stored_build> use(const std::string& hash, int64_t now_unix_ms);

  void touch(const std::string& hash, int64_t now_unix_ms);
  std::optional<edge_error> drop(const std::string& hash);

  /// Drops those of other cells that are not in use.
  void leave_cells_but(const std::string& cell,
                       const std::set<std::string>& in_use);

  /// Where a build lies that is here.
  std::filesystem::path place_of(const stored_build& build) const;

  const std::map<std::string, stored_build>& builds() const;
  uint64_t bytes() const;

private:
  void take_up(stored_build build);
  void remove_leftovers();
  std::optional<edge_error> make_room(uint64_t bytes,
                                      const std::set<std::string>& in_use);
  edge_result<stored_build> take_whole(const std::filesystem::path& from,
                                       stored_build build,
                                       const std::string& manifest,
                                       const std::set<std::string>& in_use);
  edge_result<stored_build> finish(stored_build& build,
                                   const build_manifest& manifest);
  edge_result<stored_build> move_to_place(stored_build& build,
                                          stored_build changed);

  std::filesystem::path folder_;
  uint64_t most_bytes_;
  std::function<bool(const std::filesystem::path&)> runs_here_;
  build_records records_;
  std::map<std::string, stored_build> builds_;
};

} // namespace roscell
