#pragma once

#include <filesystem>
#include <string>

namespace roscell {

/// What tells this boot of the host from all others: the kernel's id of it, and
/// when the first process was started, which is another one after a container
/// or a virtual environment that is the node's host was started again. Empty if
/// either cannot be read.
/// @param proc where proc(5) is.
std::string this_boot(const std::filesystem::path& proc = "/proc");

} // namespace roscell
