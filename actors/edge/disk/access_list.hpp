#pragma once

#include <sys/types.h>

#include <filesystem>

namespace roscell {

/// What a user may do with a file, as the three bits of its mode.
enum class access_right : unsigned {
  pass = 1,           ///< Through a folder, without seeing what is in it.
  read_and_write = 6, ///< A file, a FIFO or a socket.
};

/// Lets one more user do that, by the file's access control list; what others
/// may do stays as it is. For the file's owner. Returns false with errno set,
/// as where the file system keeps no such lists.
bool let_user(const std::filesystem::path& file, uid_t user,
              access_right right);

} // namespace roscell
