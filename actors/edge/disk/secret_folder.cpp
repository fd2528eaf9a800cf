#include "actors/edge/disk/secret_folder.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/disk/limits.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

namespace fs = std::filesystem;

/// Neither can be the end of the other, so no name of a secret is that of a
/// write which goes on.
constexpr std::string_view secret_ending = ".secret";
constexpr std::string_view part_ending = ".secret.new";

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() > end.size()
         && text.substr(text.size() - end.size()) == end;
}

/// As the schemas say it of names.
bool is_secret_name(std::string_view text) {
  const auto is_inner = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
           || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  constexpr size_t most = 63;
  return !text.empty() && text.size() <= most
         && std::string_view{"_-."}.find(text[0]) == std::string_view::npos
         && std::all_of(text.begin(), text.end(), is_inner);
}

edge_error secret_failure(const std::string& what, const fs::path& path,
                          const std::string& why) {
  return {error_code::internal,
          "cannot " + what + " '" + path.string() + "': " + why,
          "check who owns the data directory and whether its disk has room"};
}

/// What was renamed or removed in it stays so after a loss of power.
bool sync_folder(const fs::path& folder) {
  const unique_fd fd{
      ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  return fd && ::fsync(fd.get()) == 0;
}

int64_t changed_unix_ms(const struct stat& info) {
  return static_cast<int64_t>(info.st_mtim.tv_sec) * 1000
         + info.st_mtim.tv_nsec / 1'000'000;
}

/// Why it cannot be trusted; empty: it is ours, and closed to others.
std::string fault_of(const fs::path& path, mode_t kind, mode_t mode,
                     struct stat& info) {
  if (::lstat(path.c_str(), &info) != 0)
    return std::strerror(errno);
  if ((info.st_mode & S_IFMT) != kind)
    return kind == S_IFDIR ? "it is no folder" : "it is no file";
  if (info.st_uid != ::geteuid())
    return "it belongs to " + user_text(info.st_uid);
  if ((info.st_mode & 077) != 0 && ::chmod(path.c_str(), mode) != 0)
    return std::strerror(errno);
  return {};
}

/// Why a file of that name is no secret; empty: it is one.
std::string fault_of_file(const fs::path& path, struct stat& info) {
  const auto name = path.filename().string();
  if (!ends_with(name, secret_ending)
      || !is_secret_name(
          std::string_view{name}.substr(0, name.size() - secret_ending.size())))
    return "it has no name of a secret, NAME.secret";
  if (auto fault = fault_of(path, S_IFREG, 0600, info); !fault.empty())
    return fault;
  if (info.st_size == 0)
    return "it is empty";
  if (static_cast<size_t>(info.st_size) > limits::secret::bytes)
    return "it is longer than " + std::to_string(limits::secret::bytes)
           + " bytes";
  return {};
}

void take(const fs::path& path, stored_secrets& to) {
  const auto name = path.filename().string();
  if (ends_with(name, part_ending)) {
    ::unlink(path.c_str());
    return;
  }
  struct stat info {};
  if (auto fault = fault_of_file(path, info); !fault.empty())
    to.ignored.push_back({path.string(), std::move(fault)});
  else if (to.secrets.size() == limits::secret::most)
    to.ignored.push_back({path.string(), "there are more secrets than a node "
                                         "keeps"});
  else
    to.secrets.push_back({name.substr(0, name.size() - secret_ending.size()),
                          changed_unix_ms(info)});
}

} // namespace

secret_folder::secret_folder(fs::path folder) : folder_{std::move(folder)} {}

fs::path secret_folder::file_of(const std::string& name) const {
  return folder_ / (name + std::string{secret_ending});
}

stored_secrets secret_folder::look() const {
  stored_secrets result;
  struct stat info {};
  if (::lstat(folder_.c_str(), &info) != 0 && errno == ENOENT)
    return result;
  if (auto fault = fault_of(folder_, S_IFDIR, 0700, info); !fault.empty()) {
    result.ignored.push_back({folder_.string(), std::move(fault)});
    return result;
  }
  std::vector<fs::path> found;
  std::error_code problem;
  for (fs::directory_iterator i{folder_, problem}, end; !problem && i != end;
       i.increment(problem))
    found.push_back(i->path());
  if (problem)
    result.ignored.push_back({folder_.string(), problem.message()});
  std::sort(found.begin(), found.end());
  for (const auto& path : found)
    take(path, result);
  std::sort(result.secrets.begin(), result.secrets.end(),
            [](const auto& x, const auto& y) { return x.name < y.name; });
  return result;
}

std::optional<edge_error> secret_folder::write(const std::string& name,
                                               const std::string& value) const {
  if (!make_own_folder(folder_))
    return secret_failure("keep for itself the folder", folder_,
                          std::strerror(errno));
  const auto file = file_of(name);
  if (auto why = write_lasting(file, value); !why.empty()) {
    ::unlink((file.native() + ".new").c_str());
    return edge_error{error_code::internal, std::move(why),
                      "check that the disk of the data directory has room"};
  }
  if (!sync_folder(folder_))
    return secret_failure("write", folder_, std::strerror(errno));
  return std::nullopt;
}

edge_result<std::string> secret_folder::read(const std::string& name) const {
  const auto file = file_of(name);
  errno = 0;
  if (auto value = read_small_file(file, limits::secret::bytes))
    return std::move(*value);
  return secret_failure("read the secret in", file,
                        errno != 0 ? std::strerror(errno) : "it is too long");
}

std::optional<edge_error> secret_folder::remove(const std::string& name) const {
  const auto file = file_of(name);
  if ((::unlink(file.c_str()) != 0 && errno != ENOENT) || !sync_folder(folder_))
    return secret_failure("remove", file, std::strerror(errno));
  return std::nullopt;
}

} // namespace roscell
