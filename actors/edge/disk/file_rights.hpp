#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

namespace roscell {

/// Who but this user and root may change what is at `path`, as a part of a
/// sentence: "it belongs to user 'nils'". Empty: nobody may. What is not there
/// is nobody's. Of a folder it is said what may be put into it, sticky or not.
std::string who_may_change(const std::filesystem::path& path);

/// The same for the folders and links on the way to `path`: who may put
/// something else in its place. A folder where everybody may make files is fine
/// while it is sticky, as /tmp is. Groups of the folders on the way are not
/// looked at: one that may write there may not make a folder of this user.
std::string who_may_replace(const std::filesystem::path& path);

/// "user 'nils'", or "user 1000" where he has no name.
std::string user_text(uid_t user);

/// What a user may do with a file, as the three bits of its mode.
enum class access_right : unsigned {
  pass = 1,           ///< Through a folder, without seeing what is in it.
  read = 4,           ///< A file.
  read_and_write = 6, ///< A file, a FIFO or a socket.
};

/// Lets one more user do that, by the file's access control list; what others
/// may do stays as it is. For the file's owner. Returns false with errno set,
/// as where the file system keeps no such lists.
bool let_user(const std::filesystem::path& file, uid_t user,
              access_right right);

/// Makes a folder for this user alone where everybody may make one, unless it
/// is there. Returns false with errno set when it cannot be made, or, with
/// EPERM, when somebody else was there first and could change what is in it.
bool make_own_folder(const std::filesystem::path& path);

} // namespace roscell
