#include "actors/instances/engine/podman_document.hpp"

#include <algorithm>
#include <string>

namespace roscell {

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
