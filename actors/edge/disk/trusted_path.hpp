#pragma once

#include <filesystem>
#include <string>

#include <sys/types.h>

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

} // namespace roscell
