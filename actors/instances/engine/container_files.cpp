#include "actors/instances/engine/container_files.hpp"

#include "messages/stream_protocols.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

bool is_device(const std::string& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0
         && (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode));
}

bool is_path(const io_endpoint& x) {
  return (x.protocol == protocols::file || x.protocol == protocols::video)
         && x.endpoint.substr(0, 1) == "/";
}

/// The path without '/' at its end and without "..", as a mount point.
std::string plain(const std::string& path) {
  auto result = fs::path{path}.lexically_normal().string();
  if (result.size() > 1 && result.back() == '/')
    result.pop_back();
  return result;
}

void add_mount(container_files& files, container_mount mount) {
  const auto same = [&](const auto& x) { return x.target == mount.target; };
  auto& xs = files.mounts;
  const auto i = std::find_if(xs.begin(), xs.end(), same);
  if (i == xs.end())
    xs.push_back(std::move(mount));
  else
    i->read_only = i->read_only && mount.read_only;
}

void add_input(container_files& files, const std::string& endpoint) {
  auto path = plain(endpoint);
  std::error_code error;
  if (!fs::exists(path, error))
    path = fs::path{path}.parent_path().string();
  if (is_device(path))
    files.devices.push_back(path);
  else if (fs::exists(path, error) && path.size() > 1)
    add_mount(files, {path, path, true});
}

/// Why an output cannot be made; empty if it is there.
std::string make_output(const std::string& endpoint) {
  std::error_code error;
  const auto path = plain(endpoint);
  const bool is_folder = endpoint.back() == '/';
  fs::create_directories(
      is_folder ? fs::path{path} : fs::path{path}.parent_path(), error);
  if (error || is_folder)
    return error ? error.message() : "";
  const int fd =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0644);
  if (fd < 0)
    return std::strerror(errno);
  ::close(fd);
  return "";
}

std::optional<edge_error> add_output(container_files& files,
                                     const std::string& endpoint) {
  const auto path = plain(endpoint);
  std::error_code error;
  const auto why = fs::exists(path, error) ? "" : make_output(endpoint);
  if (!why.empty())
    return edge_error{error_code::engine_failed,
                      "cannot make the output '" + endpoint + "': " + why,
                      "correct the endpoint or its permissions"};
  if (is_device(path))
    files.devices.push_back(path);
  else
    add_mount(files, {path, path, false});
  return std::nullopt;
}

/// "/host/path:/container/path[:ro]"
void add_volume(container_files& files, std::string volume) {
  constexpr std::string_view read_only = ":ro";
  container_mount mount;
  if (volume.size() > read_only.size()
      && volume.compare(volume.size() - read_only.size(), read_only.size(),
                        read_only)
             == 0) {
    mount.read_only = true;
    volume.resize(volume.size() - read_only.size());
  }
  const auto colon = volume.find(":/");
  mount.source = volume.substr(0, colon);
  mount.target = colon == std::string::npos ? mount.source
                                            : plain(volume.substr(colon + 1));
  add_mount(files, std::move(mount));
}

} // namespace

edge_result<container_files> files_of(const start_container& request) {
  container_files result;
  for (const auto& x : request.input)
    if (is_path(x))
      add_input(result, x.endpoint);
  for (const auto& x : request.output)
    if (is_path(x))
      if (auto error = add_output(result, x.endpoint))
        return *error;
  for (const auto& x : request.devices)
    result.devices.push_back(x);
  for (const auto& x : request.volumes)
    add_volume(result, x);
  return result;
}

} // namespace roscell
