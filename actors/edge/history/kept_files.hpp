#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

/// INTERNAL to the folder of kept logs: what lies on the disk, of which links
/// are not followed and nothing need be there any more.
namespace roscell {

bool look_at(const std::filesystem::path& path, struct stat& info);

bool is_folder(const std::filesystem::path& path);

bool is_file(const std::filesystem::path& path);

/// Calls `visit` with each path in the folder, as far as it can be read.
template <class Visit>
void for_each_in(const std::filesystem::path& folder, Visit&& visit) {
  std::error_code error;
  for (std::filesystem::directory_iterator i{folder, error}, end;
       !error && i != end; i.increment(error))
    visit(i->path());
}

/// What a file, or a folder with its files, takes on the disk.
uint64_t bytes_below(const std::filesystem::path& path);

/// Replaces the content of a file. False: it may have a part of it.
bool write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace roscell
