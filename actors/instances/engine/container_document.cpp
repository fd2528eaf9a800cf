#include "actors/instances/engine/container_document.hpp"

#include "actors/edge/engine/build_context.hpp"
#include "actors/instances/engine/container_access.hpp"
#include "actors/instances/life/instance_text.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

namespace roscell {

namespace {

constexpr int64_t mib = 1024 * 1024;

/// And where that has what it works with.
constexpr const char* exit_file_inside = "/opt/roscell/exit";
constexpr const char* fence_inside = "/opt/roscell/fence";

/// Where engines have their own secrets, too.
constexpr const char* secrets_inside = "/run/secrets";

/// Docker refuses less.
constexpr int64_t least_memory = 6 * mib;

/// More than any skill of ours needs, and less than what an engine under the
/// usual limits may grant.
constexpr rlim_t most_files = 65'536;
constexpr rlim_t most_processes = 4'096;

json mount_json(const container_mount& x) {
  return {{"Type", "bind"},
          {"Source", x.source},
          {"Target", x.target},
          {"ReadOnly", x.read_only}};
}

json device_json(const std::string& path) {
  return {{"PathOnHost", path},
          {"PathInContainer", path},
          {"CgroupPermissions", "rwm"}};
}

/// An engine gives its own limits, which it may not be allowed to give. What
/// this process has is allowed.
json limit_json(const char* name, int resource, rlim_t most) {
  rlimit own{};
  ::getrlimit(static_cast<__rlimit_resource_t>(resource), &own);
  const auto value = std::min(own.rlim_cur, most);
  return {{"Name", name}, {"Soft", value}, {"Hard", value}};
}

json environment_json(const start_container& request) {
  auto variables = request.environment;
  variables["NOTIFY_SOCKET"] =
      std::string{container_notify_dir} + '/' + notify_socket_name;
  // The image's own setting would be replaced, and the libraries not found.
  if (const auto i = variables.find("LD_LIBRARY_PATH"); i != variables.end())
    i->second = std::string{image_library_dir} + ':' + i->second;
  if (!request.secrets_folder.empty())
    variables[secrets_variable] = secrets_inside;
  // The only GPU that a container sees is its first.
  if (request.gpu >= 0)
    variables["CUDA_VISIBLE_DEVICES"] = "0";
  json result = json::array();
  for (const auto& [name, value] : variables)
    result.push_back(std::string{name}.append("=").append(value));
  return result;
}

json labels_json(const start_container& request,
                 const container_setting& node) {
  json result{{"roscell.node", node.node_uuid}};
  for (const auto& [name, value] : request.labels)
    result["roscell." + name] = value;
  return result;
}

void limit_resources(json& host, const resource_request& limits) {
  if (limits.memory_mib > 0) {
    const auto bytes = std::max(
        least_memory, static_cast<int64_t>(std::ceil(limits.memory_mib)) * mib);
    host["Memory"] = bytes;
    // No swap beside it.
    host["MemorySwap"] = bytes;
  }
  const double cores = std::max(1U, std::thread::hardware_concurrency());
  if (limits.cpu > 0)
    host["NanoCpus"] =
        static_cast<int64_t>(std::clamp(limits.cpu, 0.01, cores) * 1e9);
}

json host_json(const start_container& request, const container_files& files,
               const container_setting& setting,
               const std::string& notify_dir) {
  // Shared memory and the discovery server's address work as for a process.
  json result{{"NetworkMode", "host"}, {"IpcMode", "host"}};
  auto& mounts = result["Mounts"];
  mounts.push_back(mount_json({notify_dir, container_notify_dir, true}));
  for (const auto& x : files.mounts)
    mounts.push_back(mount_json(x));
  for (const auto& x : files.devices)
    result["Devices"].push_back(device_json(x));
  result["Ulimits"] = {limit_json("nofile", RLIMIT_NOFILE, most_files),
                       limit_json("nproc", RLIMIT_NPROC, most_processes)};
  result["LogConfig"] = {{"Type", "json-file"},
                         {"Config",
                          {{"max-size", std::to_string(setting.log_bytes / 2)},
                           {"max-file", "2"}}}};
  limit_resources(result, request.limits);
  bound_powers(result, request, setting.rootless);
  if (request.gpu >= 0)
    result["DeviceRequests"].push_back(
        {{"Driver", "nvidia"},
         {"DeviceIDs", json::array({std::to_string(request.gpu)})},
         {"Capabilities", json::array({json::array({"gpu"})})}});
  return result;
}

bool is_fenced(const start_container& request) {
  return request.fence_boot_ms != 0;
}

/// Whether it is a program of the base image; else it is the skill's.
bool is_of_base(const start_container& request) {
  return !request.command.empty() && request.command.front().front() == '/';
}

/// The shim runs what the image would have run.
std::vector<std::string> shim_command(const start_container& request,
                                      bool rootless) {
  std::vector<std::string> result{shim_inside, "--exit", exit_file_inside,
                                  "--stop-signal",
                                  std::to_string(request.stop_signal)};
  if (is_fenced(request))
    result.insert(result.end(), {"--fence", fence_inside});
  if (const auto word = scheduling_word(request.scheduling); !word.empty())
    result.insert(result.end(), {"--scheduling", word});
  const auto who = identity_options(request, rootless);
  result.insert(result.end(), who.begin(), who.end());
  result.push_back("--");
  auto program = request.command;
  if (!is_of_base(request))
    program.at(0) = std::string{image_skill_dir} + '/' + program.at(0);
  result.insert(result.end(), program.begin(), program.end());
  return result;
}

} // namespace

std::string container_name(const std::string& instance) {
  return "roscell-" + instance;
}

json container_document(const start_container& request,
                        const container_files& files,
                        const container_setting& setting,
                        const std::string& notify_dir,
                        const container_shim& shim) {
  auto seen = files;
  seen.mounts.push_back({shim.program, shim_inside, true});
  seen.mounts.push_back({shim.exit_file, exit_file_inside, false});
  if (is_fenced(request))
    seen.mounts.push_back({shim.fence, fence_inside, true});
  if (!request.secrets_folder.empty())
    seen.mounts.push_back({request.secrets_folder, secrets_inside, true});
  return json{{"Image", request.image},
              {"User", container_user(request, setting.rootless)},
              {"Env", environment_json(request)},
              {"Labels", labels_json(request, setting)},
              // Signs of life come by the NOTIFY_SOCKET; the base image's own
              // check would only cost.
              {"Healthcheck", {{"Test", json::array({"NONE"})}}},
              {"HostConfig", host_json(request, seen, setting, notify_dir)},
              // The shim is asked to end in one way, and passes it on in the
              // skill's.
              {"StopSignal", std::to_string(SIGTERM)},
              {"Entrypoint", shim_command(request, setting.rootless)}};
}

namespace {

/// As "NAME=value" in Docker's form.
json environment_of(const json& docker) {
  json result = json::object();
  for (const auto& x : docker.at("Env")) {
    const auto text = x.get<std::string>();
    const auto equals = text.find('=');
    result[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return result;
}

json mount_options_of(const std::string& list) {
  json result = json::array();
  for (size_t at = 0; at < list.size();) {
    const auto comma = std::min(list.find(',', at), list.size());
    result.push_back(list.substr(at, comma - at));
    at = comma + 1;
  }
  return result;
}

json mounts_of(const json& host) {
  json result = json::array();
  for (const auto& x : host.at("Mounts"))
    result.push_back(
        {{"type", x.at("Type")},
         {"source", x.at("Source")},
         {"destination", x.at("Target")},
         {"options",
          json::array({"rbind", x.at("ReadOnly") == true ? "ro" : "rw"})}});
  const auto memory = host.value("Tmpfs", json::object());
  for (const auto& [folder, options] : memory.items())
    result.push_back(
        {{"type", "tmpfs"},
         {"source", "tmpfs"},
         {"destination", folder},
         {"options", mount_options_of(options.get<std::string>())}});
  return result;
}

json devices_of(const json& host) {
  json result = json::array();
  for (const auto& x : host.value("Devices", json::array())) {
    std::string path;
    for (const auto* part :
         {"PathOnHost", "PathInContainer", "CgroupPermissions"})
      path += (path.empty() ? "" : ":") + x.at(part).get<std::string>();
    result.push_back({{"path", path}});
  }
  for (const auto& x : host.value("DeviceRequests", json::array()))
    for (const auto& id : x.at("DeviceIDs"))
      result.push_back({{"path", "nvidia.com/gpu=" + id.get<std::string>()}});
  return result;
}

json limits_of(const json& host) {
  json result = json::array();
  for (const auto& x : host.at("Ulimits"))
    result.push_back({{"type", x.at("Name")},
                      {"soft", x.at("Soft")},
                      {"hard", x.at("Hard")}});
  return result;
}

json resources_of(const json& host) {
  constexpr int64_t period_us = 100'000;
  json result = json::object();
  if (host.count("Memory") != 0)
    result["memory"] = {{"limit", host.at("Memory")},
                        {"swap", host.at("MemorySwap")}};
  // The kernel takes no quota below 1 ms.
  if (host.count("NanoCpus") != 0)
    result["cpu"] = {
        {"period", period_us},
        {"quota", std::max<int64_t>(1'000, host.at("NanoCpus").get<int64_t>()
                                               / (1'000'000'000 / period_us))}};
  return result;
}

} // namespace

json podman_document(const std::string& name, const json& docker) {
  const auto& host = docker.at("HostConfig");
  const auto& log = host.at("LogConfig").at("Config");
  json result{
      {"name", name},
      {"image", docker.at("Image")},
      {"user", docker.at("User")},
      {"env", environment_of(docker)},
      {"labels", docker.at("Labels")},
      {"healthconfig", docker.at("Healthcheck")},
      {"groups", host.at("GroupAdd")},
      {"cap_add", host.at("CapAdd")},
      {"cap_drop", host.at("CapDrop")},
      {"no_new_privileges", true},
      {"read_only_filesystem", host.at("ReadonlyRootfs")},
      {"netns", {{"nsmode", host.at("NetworkMode")}}},
      {"ipcns", {{"nsmode", host.at("IpcMode")}}},
      {"mounts", mounts_of(host)},
      {"devices", devices_of(host)},
      {"r_limits", limits_of(host)},
      {"resource_limits", resources_of(host)},
      {"log_configuration",
       {{"driver", "k8s-file"},
        {"size", std::stoll(log.at("max-size").get<std::string>())}}},
      {"stop_signal", std::stoi(docker.at("StopSignal").get<std::string>())}};
  if (docker.count("Entrypoint") != 0)
    result["entrypoint"] = docker.at("Entrypoint");
  return result;
}

} // namespace roscell
