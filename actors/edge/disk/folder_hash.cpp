#include "actors/edge/disk/folder_hash.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Thrown inside this file only.
struct hash_failure {
  edge_error why;
};

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw hash_failure{{error_code::schema_violation,
                      "'" + path.string() + "' " + why,
                      "a skill folder holds files and folders only"}};
}

[[noreturn]] void unreadable(const fs::path& path, const std::string& why) {
  throw hash_failure{{error_code::internal,
                      "cannot read '" + path.string() + "': " + why,
                      "give this user read access to the skill folder"}};
}

struct digest_closer {
  void operator()(EVP_MD_CTX* x) const {
    EVP_MD_CTX_free(x);
  }
};

class sha256 {
public:
  sha256() : context_(EVP_MD_CTX_new()) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }

  void add(const void* data, size_t size) {
    EVP_DigestUpdate(context_.get(), data, size);
  }

  /// Adds a text so that no other sequence of texts gives the same bytes.
  void add(const std::string& text) {
    const auto size = std::to_string(text.size()) + ':';
    add(size.data(), size.size());
    add(text.data(), text.size());
  }

  std::string hex() {
    digest result{};
    EVP_DigestFinal_ex(context_.get(), result.data(), nullptr);
    return to_hex(result);
  }

private:
  std::unique_ptr<EVP_MD_CTX, digest_closer> context_;
};

/// The files and links below the folder, relative to it, in order.
std::vector<fs::path> list(const fs::path& folder,
                           const folder_limits& limits) {
  std::vector<fs::path> result;
  std::error_code error;
  // Links to folders are not followed.
  fs::recursive_directory_iterator i{folder, error};
  for (const fs::recursive_directory_iterator end; !error && i != end;
       i.increment(error)) {
    if (i.depth() >= limits.max_depth)
      refuse(i->path(), "lies too deep");
    if (i->symlink_status(error).type() == fs::file_type::directory)
      continue;
    if (result.size() == limits.max_files)
      refuse(folder, "has too many files");
    result.push_back(i->path().lexically_relative(folder));
  }
  if (error)
    unreadable(folder, error.message());
  std::sort(result.begin(), result.end(), [](const auto& x, const auto& y) {
    return x.native() < y.native();
  });
  return result;
}

void add_link(sha256& sum, const fs::path& folder, const fs::path& name) {
  std::error_code error;
  const auto target = fs::read_symlink(folder / name, error);
  if (error)
    unreadable(folder / name, error.message());
  const auto root = fs::weakly_canonical(folder, error);
  const auto real = fs::weakly_canonical(folder / name, error);
  const auto inside = real.lexically_relative(root);
  if (error || target.is_absolute() || inside.empty()
      || *inside.begin() == "..")
    refuse(folder / name, "is a link that leads out of the folder");
  sum.add("link");
  sum.add(target.string());
}

void add_file(sha256& sum, const fs::path& path, uint64_t& bytes_left) {
  const unique_fd fd{
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  struct stat info {};
  if (!fd || ::fstat(fd.get(), &info) != 0)
    unreadable(path, std::strerror(errno));
  if (!S_ISREG(info.st_mode))
    refuse(path, "is neither a file nor a folder");
  sum.add((info.st_mode & S_IXUSR) != 0 ? "program" : "file");
  // A sum of its own: the size is known at the end only, for the file may grow
  // meanwhile.
  sha256 content;
  std::vector<char> buffer(64 * 1024);
  for (;;) {
    const auto n = ::read(fd.get(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      unreadable(path, std::strerror(errno));
    if (n == 0)
      break;
    if (static_cast<uint64_t>(n) > bytes_left)
      refuse(path, "makes the folder too large");
    bytes_left -= static_cast<uint64_t>(n);
    content.add(buffer.data(), static_cast<size_t>(n));
  }
  sum.add(content.hex());
}

void add_look(sha256& sum, const fs::path& folder, const fs::path& name,
              folder_fingerprint& look) {
  struct stat info {};
  if (::lstat((folder / name).c_str(), &info) != 0)
    unreadable(folder / name, std::strerror(errno));
  sum.add(name.string());
  for (const auto number :
       {static_cast<int64_t>(info.st_dev), static_cast<int64_t>(info.st_ino),
        static_cast<int64_t>(info.st_size),
        static_cast<int64_t>(info.st_ctim.tv_sec),
        static_cast<int64_t>(info.st_ctim.tv_nsec)})
    sum.add(std::to_string(number));
  look.changed_unix_ms =
      std::max(look.changed_unix_ms,
               static_cast<int64_t>(info.st_ctim.tv_sec) * 1000
                   + static_cast<int64_t>(info.st_ctim.tv_nsec) / 1'000'000);
}

} // namespace

edge_result<folder_fingerprint> read_folder(const fs::path& folder,
                                            const folder_limits& limits) {
  try {
    sha256 sum;
    folder_fingerprint result;
    for (const auto& name : list(folder, limits))
      add_look(sum, folder, name, result);
    result.state = sum.hex();
    return result;
  } catch (const hash_failure& failure) {
    return failure.why;
  }
}

edge_result<std::string> hash_folder(const fs::path& folder,
                                     const folder_limits& limits) {
  try {
    sha256 sum;
    auto bytes_left = limits.max_bytes;
    for (const auto& name : list(folder, limits)) {
      sum.add(name.string());
      std::error_code error;
      if (fs::is_symlink(fs::symlink_status(folder / name, error)))
        add_link(sum, folder, name);
      else
        add_file(sum, folder / name, bytes_left);
    }
    return sum.hex();
  } catch (const hash_failure& failure) {
    return failure.why;
  }
}

} // namespace roscell
