#include "actors/edge/process/fence_file.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Marks the hash as this use's own.
constexpr std::string_view fence_hash_key = "roscell fence";

constexpr size_t name_digits = 32;

edge_error fence_failure(const std::string& what, const fs::path& path) {
  return {error_code::engine_failed,
          "cannot " + what + " the fence '" + path.string()
              + "': " + std::strerror(errno),
          "check who owns the folder and whether /dev/shm has room"};
}

/// All of it or nothing, for the shim may read at any moment.
bool store(int file, int64_t boot_ms) {
  const auto n = ::pwrite(file, &boot_ms, sizeof(boot_ms), 0);
  if (n >= 0 && n != static_cast<ssize_t>(sizeof(boot_ms)))
    errno = ENOSPC;
  return n == static_cast<ssize_t>(sizeof(boot_ms));
}

} // namespace

fs::path fence_path(const fs::path& instance_dir) {
  const auto whose = fs::absolute(instance_dir).lexically_normal();
  const auto name = to_hex(hmac_sha256(fence_hash_key, whose.native()));
  return fs::path{"/dev/shm/roscell-" + std::to_string(::geteuid())}
         / name.substr(0, name_digits);
}

std::optional<edge_error> make_fence(const fs::path& path, int64_t boot_ms) {
  if (!make_own_folder(path.parent_path()))
    return fence_failure("make the folder of", path);
  ::unlink(path.c_str());
  const unique_fd file{
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  if (!file || !store(file.get(), boot_ms))
    return fence_failure("make", path);
  return std::nullopt;
}

std::optional<edge_error> move_fence(const fs::path& path, int64_t boot_ms) {
  const unique_fd file{::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW)};
  if (!file)
    return fence_failure("move on", path);
  int64_t before = 0;
  const auto n = ::pread(file.get(), &before, sizeof(before), 0);
  if (n == static_cast<ssize_t>(sizeof(before)) && before >= boot_ms)
    return std::nullopt;
  if (n < 0 || !store(file.get(), boot_ms))
    return fence_failure("move on", path);
  return std::nullopt;
}

void remove_fence(const fs::path& path) {
  ::unlink(path.c_str());
}

} // namespace roscell
