#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

namespace roscell::shim {

/// Who the command is to be, whatever the shim is.
struct identity {
  /// The kernel takes more, but a user of a host is in fewer.
  static constexpr std::size_t most_groups = 256;

  bool has_user = false; ///< Else it stays the shim's.
  uid_t user = 0;
  gid_t group = 0;
  gid_t groups[most_groups] = {};
  std::size_t group_count = 0;
  bool has_capabilities = false;  ///< Else they stay the shim's.
  std::uint64_t capabilities = 0; ///< By the kernel's numbers.
};

/// Reads "UID:GID[,GROUP...]". Returns whether it is one.
bool read_user(const char* text, identity& result);

/// Reads a hexadecimal number. Returns whether it is one.
bool read_capabilities(const char* text, identity& result);

/// Makes the calling process that. It keeps those of the capabilities that it
/// has, hands them on to what it runs, and gains none by running anything.
/// Clears what a process is to get when its parent ends. Returns false with
/// errno set.
bool take_identity(const identity& wanted);

} // namespace roscell::shim
