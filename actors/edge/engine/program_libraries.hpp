#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// A shared library of this host that a program needs.
struct shared_library {
  std::string name;           ///< What the program asks for: "libz.so.1".
  std::filesystem::path file; ///< Where it is, without links.
  uint64_t bytes = 0;
  int64_t modified_unix_s = 0;
};

/// Whether the file has the size and the time that were found.
bool is_still(const shared_library& library);

/// One line of what the dynamic linker says that it would load.
struct needed_library {
  std::string name; ///< With the version, if that is all that is not found.
  std::string path; ///< Empty: it is not found.
};

/// Reads the dynamic linker's words: "\tlibz.so.1 => /lib/libz.so.1 (0x7f...)",
/// "PROGRAM: /lib/libz.so.1: version `ZLIB_1.3' not found (required by ...)".
/// Lines of another form are left out.
std::vector<needed_library> parse_library_list(std::string_view words);

/// Whether a library belongs to the C library, which every image must bring
/// itself: it fits to the image's own dynamic linker only.
bool is_c_library(std::string_view name);

/// The libraries that a program needs, by itself or for others, and that this
/// host has not, or not in that version. Empty for a script, and for what
/// another dynamic linker starts. Blocks on the dynamic
/// linker, some milliseconds.
///
/// Errors: engine_failed (it cannot be loaded at all, or nothing could be
/// started), timeout.
edge_result<std::vector<std::string>>
missing_libraries(const std::filesystem::path& program);

/// What the programs and libraries in a skill folder need of this host, in the
/// order of names: the closure that the dynamic linker finds, without what is
/// in the folder itself and without the C library. Starts nothing of the
/// folder. Blocks on the disk and on the dynamic linker, some milliseconds for
/// each program.
///
/// Errors: engine_failed (`program` needs a library that this host has not, or
/// is made for another machine), internal.
edge_result<std::vector<shared_library>>
find_libraries(const std::filesystem::path& folder,
               const std::filesystem::path& program);

} // namespace roscell
