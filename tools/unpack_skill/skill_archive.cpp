#include "tools/unpack_skill/skill_archive.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Thrown inside this file only.
struct archive_failure {
  edge_error why;
};

[[noreturn]] void refuse_archive(const std::string& what,
                                 const std::string& why) {
  throw archive_failure{{error_code::schema_violation, what + " " + why,
                         "an archive of a skill holds the files, folders and "
                         "inner links of its folder only"}};
}

[[noreturn]] void fail_on_disk(const fs::path& path) {
  throw archive_failure{
      {error_code::internal,
       "cannot write '" + path.string() + "': " + std::strerror(errno), ""}};
}

struct archive_closer {
  void operator()(archive* x) const {
    archive_read_free(x);
  }
};

using archive_ptr = std::unique_ptr<archive, archive_closer>;

archive_ptr open_archive(const fs::path& path) {
  constexpr size_t block_bytes = 64 * 1024;
  archive_ptr result{archive_read_new()};
  archive_read_support_filter_all(result.get());
  archive_read_support_format_tar(result.get());
  archive_read_support_format_zip(result.get());
  if (archive_read_open_filename(result.get(), path.c_str(), block_bytes)
      != ARCHIVE_OK)
    refuse_archive("'" + path.string() + "'",
                   std::string{"is no tar or zip archive: "}
                       + archive_error_string(result.get()));
  return result;
}

/// Whether a relative path stays in the folder that it begins in.
bool stays_in(const fs::path& path) {
  const auto normal = path.lexically_normal();
  return !path.is_absolute() && !normal.empty() && *normal.begin() != "..";
}

/// Unpacks one archive, entry by entry.
class unpacking {
public:
  unpacking(const fs::path& from, fs::path into, const archive_limits& limits)
      : archive_(open_archive(from)), into_(std::move(into)), limits_(limits) {
    std::error_code ignored;
    const auto size = fs::file_size(from, ignored);
    bytes_left_ =
        std::min(limits.max_bytes,
                 limits.free_bytes + (ignored ? 0 : size * limits.max_ratio));
  }

  void unpack_all() {
    archive_entry* entry = nullptr;
    for (;;) {
      const int read = archive_read_next_header(archive_.get(), &entry);
      if (read == ARCHIVE_EOF)
        break;
      if (read != ARCHIVE_OK)
        refuse_archive("the archive",
                       std::string{"cannot be read: "}
                           + archive_error_string(archive_.get()));
      unpack(entry);
    }
    // Only now, so that no file was written through one.
    for (const auto& [name, target] : links_)
      make_link(name, target);
  }

private:
  void unpack(archive_entry* entry) {
    const auto* text = archive_entry_pathname(entry);
    const fs::path name = text == nullptr ? "" : text;
    const auto what = "'" + name.string() + "' in the archive";
    if (!stays_in(name))
      refuse_archive(what, "leads out of its folder");
    if (++files_ > limits_.max_files)
      refuse_archive("the archive", "has too many files");
    if (archive_entry_hardlink(entry) != nullptr)
      refuse_archive(what, "is a hard link");
    if ((archive_entry_perm(entry) & (S_ISUID | S_ISGID)) != 0)
      refuse_archive(what, "has a set-uid or set-gid bit");
    switch (archive_entry_filetype(entry)) {
    case AE_IFDIR:
      return make_folder(into_ / name);
    case AE_IFREG:
      return write_file(name, (archive_entry_perm(entry) & S_IXUSR) != 0);
    case AE_IFLNK:
      return note_link(name, archive_entry_symlink(entry), what);
    default:
      refuse_archive(what, "is a device, pipe or socket");
    }
  }

  void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (!error)
      return;
    errno = error.value();
    fail_on_disk(path);
  }

  void write_file(const fs::path& name, bool program) {
    constexpr mode_t file_mode = 0644;
    constexpr mode_t program_mode = 0755;
    const auto path = into_ / name;
    make_folder(path.parent_path());
    const unique_fd fd{::open(
        path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW,
        program ? program_mode : file_mode)};
    if (!fd)
      fail_on_disk(path);
    std::vector<char> buffer(64 * 1024);
    for (;;) {
      const auto n =
          archive_read_data(archive_.get(), buffer.data(), buffer.size());
      if (n == 0)
        return;
      if (n < 0)
        refuse_archive("'" + name.string() + "' in the archive",
                       std::string{"cannot be read: "}
                           + archive_error_string(archive_.get()));
      const auto size = static_cast<size_t>(n);
      if (size > bytes_left_)
        refuse_archive("the archive", "holds more than a skill may");
      bytes_left_ -= size;
      if (!write_whole(fd.get(), {buffer.data(), size}))
        fail_on_disk(path);
    }
  }

  void note_link(const fs::path& name, const char* target,
                 const std::string& what) {
    const fs::path to = target == nullptr ? "" : target;
    if (to.empty() || to.is_absolute() || !stays_in(name.parent_path() / to))
      refuse_archive(what, "is a link that leads out of its folder");
    links_.emplace_back(name, to);
  }

  void make_link(const fs::path& name, const fs::path& target) {
    const auto path = into_ / name;
    make_folder(path.parent_path());
    if (::symlink(target.c_str(), path.c_str()) != 0)
      fail_on_disk(path);
  }

  archive_ptr archive_;
  fs::path into_;
  archive_limits limits_;
  uint64_t bytes_left_ = 0;
  size_t files_ = 0;
  std::vector<std::pair<fs::path, fs::path>> links_;
};

/// Archives are often made of the folder itself, not of what is in it.
fs::path top_of(const fs::path& folder) {
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error))
    entries.push_back(*i);
  const bool one = entries.size() == 1 && entries.front().is_directory()
                   && !entries.front().is_symlink();
  return one ? entries.front().path() : folder;
}

} // namespace

edge_result<fs::path> unpack_skill(const fs::path& archive,
                                   const fs::path& into,
                                   const archive_limits& limits) {
  try {
    unpacking{archive, into, limits}.unpack_all();
    return top_of(into);
  } catch (const archive_failure& failure) {
    return failure.why;
  }
}

} // namespace roscell
