#include "actors/edge/disk/build_pieces.hpp"

#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr mode_t unfinished_mode = 0600;

/// A part of a file that lies in a piece.
struct file_part {
  const build_file* file;
  uint64_t offset; ///< In the file.
  uint64_t size;
};

std::vector<file_part> parts_of(const build_manifest& manifest, size_t piece) {
  std::vector<file_part> result;
  const auto begin = piece * build_piece_bytes;
  const auto end = begin + piece_size(manifest, piece);
  uint64_t at = 0;
  for (const auto& x : manifest.files) {
    const auto next = at + static_cast<uint64_t>(x.bytes);
    if (x.bytes > 0 && next > begin && at < end) {
      const auto from = std::max(at, begin);
      result.push_back({&x, from - at, std::min(next, end) - from});
    }
    at = next;
  }
  return result;
}

edge_error disk_problem(const std::string& what, const fs::path& path) {
  const int why = errno;
  return {error_code::internal,
          "cannot " + what + " '" + path.string() + "': " + std::strerror(why),
          why == ENOSPC || why == EDQUOT
              ? "make room on the disk; what has come is kept"
              : ""};
}

/// Calls `move` until it has moved all; it says how much of the rest it has.
bool move_all(uint64_t size, const std::function<ssize_t(uint64_t)>& move) {
  for (uint64_t done = 0; done < size;) {
    const auto n = move(done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return false;
    done += static_cast<uint64_t>(n);
  }
  return true;
}

std::optional<edge_error> read_part(const fs::path& folder,
                                    const file_part& part, char* to) {
  const auto path = folder / part.file->path;
  const unique_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  errno = 0;
  if (fd && move_all(part.size, [&](uint64_t done) {
        return ::pread(fd.get(), to + done, part.size - done,
                       static_cast<off_t>(part.offset + done));
      }))
    return std::nullopt;
  if (fd && errno == 0)
    return edge_error{error_code::conflict,
                      "'" + path.string() + "' is shorter than it was", ""};
  return disk_problem("read", path);
}

std::optional<edge_error> write_part(const fs::path& folder,
                                     const file_part& part, const char* from) {
  const auto path = folder / part.file->path;
  const unique_fd fd{::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW)};
  if (fd && move_all(part.size, [&](uint64_t done) {
        return ::pwrite(fd.get(), from + done, part.size - done,
                        static_cast<off_t>(part.offset + done));
      }))
    return std::nullopt;
  return disk_problem("write", path);
}

/// Room is taken at once, so that a disk that is too small is told before
/// anything has come.
std::optional<edge_error> reserve_file(const fs::path& path, int64_t bytes) {
  const unique_fd fd{::open(path.c_str(),
                            O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW,
                            unfinished_mode)};
  if (!fd || ::ftruncate(fd.get(), bytes) != 0)
    return disk_problem("write", path);
  if (bytes == 0)
    return std::nullopt;
  errno = ::posix_fallocate(fd.get(), 0, bytes);
  return errno == 0 ? std::nullopt
                    : std::optional{disk_problem("reserve room for", path)};
}

std::optional<edge_error> finish_file(const fs::path& path, bool program) {
  constexpr mode_t file_mode = 0644;
  constexpr mode_t program_mode = 0755;
  const unique_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  if (!fd || ::fchmod(fd.get(), program ? program_mode : file_mode) != 0
      || ::fsync(fd.get()) != 0)
    return disk_problem("write", path);
  return std::nullopt;
}

std::optional<edge_error> make_link(const fs::path& path,
                                    const std::string& target) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (::symlink(target.c_str(), path.c_str()) != 0 && errno != EEXIST)
    return disk_problem("make the link", path);
  return std::nullopt;
}

} // namespace

edge_result<std::string> read_piece(const fs::path& folder,
                                    const build_manifest& manifest,
                                    size_t piece) {
  std::string result(piece_size(manifest, piece), '\0');
  size_t at = 0;
  for (const auto& part : parts_of(manifest, piece)) {
    if (auto why = read_part(folder, part, result.data() + at))
      return std::move(*why);
    at += part.size;
  }
  if (sha256_hex(result) != manifest.pieces[piece])
    return edge_error{error_code::conflict,
                      "'" + folder.string() + "' holds other bytes than piece "
                          + std::to_string(piece) + " of its build",
                      "remove the folder; it is fetched again"};
  return result;
}

std::optional<edge_error> begin_build(const fs::path& folder,
                                      const build_manifest& manifest) {
  for (const auto& x : manifest.files) {
    if (!x.link.empty())
      continue;
    const auto path = folder / x.path;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (auto why = reserve_file(path, x.bytes))
      return why;
  }
  return std::nullopt;
}

std::vector<bool> find_pieces(const fs::path& folder,
                              const build_manifest& manifest) {
  std::vector<bool> result;
  for (size_t i = 0; i < manifest.pieces.size(); ++i)
    result.push_back(
        std::holds_alternative<std::string>(read_piece(folder, manifest, i)));
  return result;
}

std::optional<edge_error> write_piece(const fs::path& folder,
                                      const build_manifest& manifest,
                                      size_t piece, std::string_view bytes) {
  if (piece >= manifest.pieces.size()
      || bytes.size() != piece_size(manifest, piece)
      || sha256_hex(bytes) != manifest.pieces[piece])
    return edge_error{error_code::schema_violation,
                      "these are not the bytes of piece "
                          + std::to_string(piece) + " of the build",
                      ""};
  size_t at = 0;
  for (const auto& part : parts_of(manifest, piece)) {
    if (auto why = write_part(folder, part, bytes.data() + at))
      return why;
    at += part.size;
  }
  return std::nullopt;
}

std::optional<edge_error> finish_build(const fs::path& folder,
                                       const build_manifest& manifest,
                                       const build_name& name) {
  for (const auto& x : manifest.files)
    if (auto why = x.link.empty() ? finish_file(folder / x.path, x.program)
                                  : make_link(folder / x.path, x.link))
      return why;
  const auto hash = hash_folder(folder);
  if (const auto* why = std::get_if<edge_error>(&hash))
    return *why;
  if (std::get<std::string>(hash) == name.hash)
    return std::nullopt;
  return edge_error{error_code::conflict,
                    "'" + folder.string() + "' is not the build "
                        + name.hash.substr(0, 12),
                    "it is removed, and fetched again"};
}

} // namespace roscell
