#include "tools/roscell/doctor/host/process_maps.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string_view>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

bool path_has_prefix(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

/// A line of proc(5): "7f00-7f80 rw-s 00000000 00:1b 93  /dev/shm/file".
void visit_line(const fs::path& process, const std::string& line,
                const std::string& below,
                const std::function<void(const mapped_file&)>& visit) {
  // Most lines are of libraries, and are not taken apart.
  if (line.find(below) == line.npos)
    return;
  std::istringstream in{line};
  std::string range, rights, offset, device, inode, path;
  in >> range >> rights >> offset >> device >> inode >> std::ws;
  std::getline(in, path);
  // Whoever is in a chroot sees what is mounted elsewhere by the way from the
  // host's root.
  std::error_code error;
  const auto root = fs::read_symlink(process / "root", error).string();
  for (const auto& begin : {below, root + below})
    if (path_has_prefix(path, begin))
      return visit({process, device, path.substr(begin.size())});
}

} // namespace

size_t
visit_mapped_files(const fs::path& proc, const fs::path& folder,
                   const std::function<void(const mapped_file&)>& visit) {
  const auto below = folder.string() + "/";
  size_t closed = 0;
  std::error_code error;
  for (fs::directory_iterator i{proc, error}, end; !error && i != end;
       i.increment(error)) {
    const auto name = i->path().filename().string();
    if (name.find_first_not_of("0123456789") != name.npos)
      continue;
    errno = 0;
    std::ifstream in{i->path() / "maps"};
    // One that has ended meanwhile cannot be opened either, and maps nothing.
    if (!in && (errno == EACCES || errno == EPERM))
      ++closed;
    for (std::string line; std::getline(in, line);)
      visit_line(i->path(), line, below, visit);
  }
  return closed;
}

bool is_dds_file(const std::string& name) {
  // Until version 2 of Fast DDS, and since version 3.
  return path_has_prefix(name, "fastrtps_")
         || path_has_prefix(name, "fastdds_");
}

} // namespace roscell::cli
