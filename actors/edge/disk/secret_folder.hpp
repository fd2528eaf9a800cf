#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// A secret as it lies on the disk, without its value.
struct stored_secret {
  std::string name;
  int64_t set_unix_ms = 0;
};

/// Something in the folder that is none, and stays where it is.
struct ignored_entry {
  std::string path;
  std::string reason;
};

struct stored_secrets {
  std::vector<stored_secret> secrets; ///< By name.
  std::vector<ignored_entry> ignored;
};

/// The secrets of a node on its disk: a file each, which its user alone can
/// read, in a folder that only he can enter. Values are read when they are
/// wanted, and kept nowhere. Blocks on the disk.
class secret_folder {
public:
  explicit secret_folder(std::filesystem::path folder);

  /// What is in it. What others could read is closed to them, what a write that
  /// was cut short has left is removed, and what cannot be a secret is told.
  stored_secrets look() const;

  /// Replaces the value; it outlives a loss of power once this is back. The
  /// folder is made where there is none. Errors: internal.
  std::optional<edge_error> write(const std::string& name,
                                  const std::string& value) const;

  /// Errors: internal (it is gone, or not readable).
  edge_result<std::string> read(const std::string& name) const;

  /// Errors: internal.
  std::optional<edge_error> remove(const std::string& name) const;

private:
  std::filesystem::path file_of(const std::string& name) const;

  std::filesystem::path folder_;
};

} // namespace roscell
