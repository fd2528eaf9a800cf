#include "actors/edge/disk/folder_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace roscell {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_entry(const fs::path& path, const std::string& why) {
  throw folder_failure{{error_code::schema_violation,
                        "'" + path.string() + "' " + why,
                        "a skill folder holds files and folders only"}};
}

} // namespace

void throw_unreadable(const fs::path& path, const std::string& why) {
  throw folder_failure{{error_code::internal,
                        "cannot read '" + path.string() + "': " + why,
                        "give this user read access to the skill folder"}};
}

std::vector<fs::path> list_files(const fs::path& folder,
                                 const folder_limits& limits) {
  std::vector<fs::path> result;
  std::error_code error;
  fs::recursive_directory_iterator i{folder, error};
  for (const fs::recursive_directory_iterator end; !error && i != end;
       i.increment(error)) {
    if (i.depth() >= limits.max_depth)
      refuse_entry(i->path(), "lies too deep");
    if (i->symlink_status(error).type() == fs::file_type::directory)
      continue;
    if (result.size() == limits.max_files)
      refuse_entry(folder, "has too many files");
    result.push_back(i->path().lexically_relative(folder));
  }
  if (error)
    throw_unreadable(folder, error.message());
  std::sort(result.begin(), result.end(), [](const auto& x, const auto& y) {
    return x.native() < y.native();
  });
  return result;
}

bool is_link(const fs::path& path) {
  std::error_code error;
  return fs::is_symlink(fs::symlink_status(path, error));
}

std::string link_target(const fs::path& folder, const fs::path& name) {
  std::error_code error;
  const auto target = fs::read_symlink(folder / name, error);
  if (error)
    throw_unreadable(folder / name, error.message());
  const auto root = fs::weakly_canonical(folder, error);
  const auto real = fs::weakly_canonical(folder / name, error);
  const auto inside = real.lexically_relative(root);
  if (error || target.is_absolute() || inside.empty()
      || *inside.begin() == "..")
    refuse_entry(folder / name, "is a link that leads out of the folder");
  return target.string();
}

opened_file open_plain_file(const fs::path& path) {
  opened_file result;
  result.fd = unique_fd{
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  struct stat info {};
  if (!result.fd || ::fstat(result.fd.get(), &info) != 0)
    throw_unreadable(path, std::strerror(errno));
  if (!S_ISREG(info.st_mode))
    refuse_entry(path, "is neither a file nor a folder");
  result.program = (info.st_mode & S_IXUSR) != 0;
  return result;
}

void read_all(const opened_file& file, const fs::path& path,
              uint64_t& bytes_left,
              const std::function<void(std::string_view)>& on_bytes) {
  std::vector<char> buffer(64 * 1024);
  for (;;) {
    const auto n = ::read(file.fd.get(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      throw_unreadable(path, std::strerror(errno));
    if (n == 0)
      return;
    const auto size = static_cast<size_t>(n);
    if (size > bytes_left)
      refuse_entry(path, "makes the folder too large");
    bytes_left -= size;
    on_bytes({buffer.data(), size});
  }
}

} // namespace roscell
