#pragma once

#include "actors/edge/disk/folder_files.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace roscell {

/// The hash of a folder's content, made from its files in the order of their
/// paths: this is what identifies a build.
class folder_sum {
public:
  void add_link(const std::string& path, const std::string& target);

  /// @param content SHA-256 of its bytes, in hexadecimal.
  void add_file(const std::string& path, bool program,
                const std::string& content);

  std::string hex();

private:
  sha256_sum sum_;
};

/// SHA-256 over the content of a folder, as 64 hex digits: the relative paths
/// of its files in order, whether each can be executed, and its bytes. Neither
/// the folder's own name nor times, owners and empty folders matter. A symbolic
/// link counts as its target's path and must not lead out of the folder.
///
/// Errors: schema_violation (a link that leads out, a device or pipe, more than
/// the limits), internal (something cannot be read).
edge_result<std::string> hash_folder(const std::filesystem::path& folder,
                                     const folder_limits& limits = {});

/// How a folder looks without reading its files.
struct folder_fingerprint {
  /// Differs once a file has been added, removed, replaced or written.
  std::string state;
  int64_t changed_unix_ms = 0; ///< When one of its files last changed.
};

/// Looks at names, numbers, sizes and times of change (ctime, which no program
/// can set back) of the files that `hash_folder` would read.
///
/// Errors: as `hash_folder`.
edge_result<folder_fingerprint> read_folder(const std::filesystem::path& folder,
                                            const folder_limits& limits = {});

} // namespace roscell
