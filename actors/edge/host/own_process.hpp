#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace roscell {

/// What this process has cost its host since it was started. What cannot be
/// read is 0.
struct own_cost {
  double cpu_seconds = 0;
  double resident_bytes = 0;
  double pss_bytes = 0;     ///< The same, shared pages divided among users.
  double written_bytes = 0; ///< To disks.
  double open_files = 0;
  double started_s = 0; ///< When it was, after the host's boot.
};

/// @param process the process's folder in /proc; tests have their own.
own_cost read_own_cost(const std::filesystem::path& process = "/proc/self");

/// When the host was booted, in whole seconds since 1970; 0 if that is not
/// known. It stays the same unless somebody sets the host's clock.
double read_boot_time(const std::filesystem::path& file = "/proc/stat");

/// What tells this boot of the host from all others: the kernel's id of it, and
/// when the first process was started, which is another one after a container
/// or a virtual environment that is the node's host was started again. Empty if
/// either cannot be read.
/// @param proc where proc(5) is.
std::string this_boot(const std::filesystem::path& proc = "/proc");

/// Raises the process's soft limit of open descriptors to its hard limit, and
/// gives the limit that holds then. The soft one is 1,024 by default, for the
/// sake of programs that use `select`; a node has sockets of members, peers,
/// clients and instances. To be called by a program's `main`: it changes the
/// process, and what the process starts inherits it.
std::size_t raise_descriptor_limit();

// Where the other programs and the skills lie that come with this one, as it
// is built (BUILD/bin) and as it is installed (PREFIX/bin,
// PREFIX/lib/roscell).

/// The folder of the program that this process runs. Empty if it is not known.
std::filesystem::path program_folder();

/// A program that nobody types: beside one in `bin`, else where it is
/// installed. The file need not be there.
std::filesystem::path find_private(const std::filesystem::path& bin,
                                   const std::string& name);

/// The same of roscell-instance-shim.
std::filesystem::path find_shim(const std::filesystem::path& bin);

/// The folder of the skills that are installed with a program in `bin`. It need
/// not be there.
std::filesystem::path installed_skills(const std::filesystem::path& bin);

/// Whether one of `folders` is this one, by whatever path.
bool names_folder(const std::vector<std::filesystem::path>& folders,
                  const std::filesystem::path& folder);

} // namespace roscell
