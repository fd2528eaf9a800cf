#include "actors/instances/engine/container_access.hpp"

#include "actors/edge/process/privileges.hpp"
#include "messages/stream_protocols.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
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

namespace {

/// What a shim needs to make the skill what it is, and to end it all the same.
constexpr const char* shim_powers[] = {"SETUID", "SETGID", "SETPCAP", "KILL",
                                       "DAC_OVERRIDE"};

bool wants_more_of_cores(const scheduling_request& x) {
  return x.policy == "fifo" || x.policy == "rr" || x.nice < 0;
}

bool is_empowered(const start_container& request) {
  return !request.capabilities.empty()
         || wants_more_of_cores(request.scheduling);
}

/// Of the container, its shim included.
std::set<std::string> powers_of(const start_container& request) {
  std::set<std::string> result;
  if (!is_empowered(request))
    return result;
  result.insert(std::begin(shim_powers), std::end(shim_powers));
  result.insert(request.capabilities.begin(), request.capabilities.end());
  if (wants_more_of_cores(request.scheduling))
    result.insert("SYS_NICE");
  return result;
}

/// Devices of the host belong to groups that the node's user is in.
std::vector<gid_t> own_groups() {
  constexpr size_t most = 256;
  std::vector<gid_t> result(most);
  const int count = ::getgroups(static_cast<int>(most), result.data());
  result.resize(count < 0 ? 0 : static_cast<size_t>(count));
  return result;
}

std::string own_user() {
  return std::to_string(::geteuid()) + ':' + std::to_string(::getegid());
}

} // namespace

void bound_powers(json& host, const start_container& request, bool rootless) {
  host["CapDrop"] = json::array({"ALL"});
  host["CapAdd"] = powers_of(request);
  host["SecurityOpt"] = json::array({"no-new-privileges"});
  host["GroupAdd"] = json::array();
  if (!rootless)
    for (const auto group : own_groups())
      host["GroupAdd"].push_back(std::to_string(group));
  host["ReadonlyRootfs"] = request.read_only;
  if (request.read_only)
    host["Tmpfs"] = {{"/tmp", "rw,nosuid,nodev,mode=1777"}};
}

std::string container_user(const start_container& request, bool rootless) {
  return rootless || is_empowered(request) ? "0:0" : own_user();
}

std::vector<std::string> identity_options(const start_container& request,
                                          bool rootless) {
  std::array<char, 24> mask;
  const int size = std::snprintf(
      mask.data(), mask.size(), "%llx",
      static_cast<unsigned long long>(to_capabilities(request.capabilities)));
  std::vector<std::string> result{"--capabilities",
                                  {mask.data(), static_cast<size_t>(size)}};
  if (rootless || !is_empowered(request) || ::geteuid() == 0)
    return result;
  auto user = own_user();
  for (const auto group : own_groups())
    user += ',' + std::to_string(group);
  result.insert(result.end(), {"--user", user});
  return result;
}

} // namespace roscell
