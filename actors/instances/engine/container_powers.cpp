#include "actors/instances/engine/container_powers.hpp"

#include "actors/edge/process/capabilities.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <set>

namespace roscell {

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
