#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/build.hpp"

#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// A build that is on this node's disk, or on its way there.
struct stored_build {
  build_name name;
  std::vector<bool> pieces; ///< Which are here.
  bool whole = false;       ///< All are, and have been checked together.
  std::string cell;         ///< For which it was fetched.
  bool used = false;        ///< Of one that is whole: it is a skill here.
  bool pinned = false;      ///< The cell counts on it: it never goes for room.
  int64_t used_unix_ms = 0; ///< When it was asked for last.
};

/// What is written of each build beside its files: its manifest, and what the
/// node knows of it. It blocks on the disk.
///
///     FOLDER/HASH.manifest, FOLDER/HASH.json
class build_records {
public:
  explicit build_records(std::filesystem::path folder);

  /// What was written earlier and can be read; where the files are is left out.
  std::vector<stored_build> read_all() const;

  /// The manifest comes first: a record tells of one that can be read.
  /// Errors: internal (the disk).
  std::optional<edge_error> write(const stored_build& build,
                                  const std::string& manifest) const;
  std::optional<edge_error> write(const stored_build& build) const;

  /// First goes what makes it a build.
  void forget(const std::string& hash) const;
  void remove_manifest(const std::string& hash);

  /// Errors: conflict (there is none), and of a manifest that is read:
  /// schema_violation. It is valid until the next call.
  edge_result<std::string> manifest_text(const std::string& hash) const;
  edge_result<const build_manifest*> manifest_of(const build_name& name);

private:
  std::filesystem::path file(const std::string& hash, const char* suffix) const;

  std::filesystem::path folder_;
  /// The manifests that were used last, the newest first.
  std::list<std::pair<std::string, build_manifest>> manifests_;
};

/// Errors of the store and its records.
edge_error not_here(const std::string& hash);
edge_error cannot_write(const std::filesystem::path& path,
                        const std::string& why);

} // namespace roscell
