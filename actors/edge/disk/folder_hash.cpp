#include "actors/edge/disk/folder_hash.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace roscell {

namespace fs = std::filesystem;

namespace {

std::string hash_content(const opened_file& file, const fs::path& path,
                         uint64_t& bytes_left) {
  sha256_sum content;
  read_all(file, path, bytes_left,
           [&](std::string_view bytes) { content.add(bytes); });
  return content.hex();
}

void add_look(sha256_sum& sum, const fs::path& folder, const fs::path& name,
              folder_fingerprint& look) {
  struct stat info {};
  if (::lstat((folder / name).c_str(), &info) != 0)
    throw_unreadable(folder / name, std::strerror(errno));
  sum.add_text(name.string());
  for (const auto number :
       {static_cast<int64_t>(info.st_dev), static_cast<int64_t>(info.st_ino),
        static_cast<int64_t>(info.st_size),
        static_cast<int64_t>(info.st_ctim.tv_sec),
        static_cast<int64_t>(info.st_ctim.tv_nsec)})
    sum.add_text(std::to_string(number));
  look.changed_unix_ms =
      std::max(look.changed_unix_ms,
               static_cast<int64_t>(info.st_ctim.tv_sec) * 1000
                   + static_cast<int64_t>(info.st_ctim.tv_nsec) / 1'000'000);
}

} // namespace

void folder_sum::add_link(const std::string& path, const std::string& target) {
  sum_.add_text(path);
  sum_.add_text("link");
  sum_.add_text(target);
}

void folder_sum::add_file(const std::string& path, bool program,
                          const std::string& content) {
  sum_.add_text(path);
  sum_.add_text(program ? "program" : "file");
  // A sum of its own: a file's size is known at its end only.
  sum_.add_text(content);
}

std::string folder_sum::hex() {
  return sum_.hex();
}

edge_result<folder_fingerprint> read_folder(const fs::path& folder,
                                            const folder_limits& limits) {
  try {
    sha256_sum sum;
    folder_fingerprint result;
    for (const auto& name : list_files(folder, limits))
      add_look(sum, folder, name, result);
    result.state = sum.hex();
    return result;
  } catch (const folder_failure& failure) {
    return failure.why;
  }
}

edge_result<std::string> hash_folder(const fs::path& folder,
                                     const folder_limits& limits) {
  try {
    folder_sum sum;
    auto bytes_left = limits.max_bytes;
    for (const auto& name : list_files(folder, limits)) {
      const auto path = folder / name;
      if (is_link(path)) {
        sum.add_link(name.string(), link_target(folder, name));
        continue;
      }
      const auto file = open_plain_file(path);
      sum.add_file(name.string(), file.program,
                   hash_content(file, path, bytes_left));
    }
    return sum.hex();
  } catch (const folder_failure& failure) {
    return failure.why;
  }
}

} // namespace roscell
