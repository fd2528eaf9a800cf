#include "tools/roscell/doctor/network/ports.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/network/addresses.hpp"
#include "tools/roscell/doctor/network/bound_ports.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <sstream>

namespace roscell::cli {

namespace {

/// PB and DG of RTPS 2.3, 9.6.1.1.
constexpr unsigned first_dds_port = 7400;
constexpr unsigned domain_ports = 250;

/// Nodes listen at so many after the first.
constexpr unsigned public_places = 16;

constexpr size_t longest_port_text = 64UL * 1024;

/// 0, or why a socket cannot have the port.
int try_to_bind(const std::string& protocol, const std::string& address,
                uint16_t port) {
  const bool tcp = protocol == "tcp";
  const unique_fd fd{
      socket(AF_INET, (tcp ? SOCK_STREAM : SOCK_DGRAM) | SOCK_CLOEXEC, 0)};
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  inet_pton(AF_INET, address.c_str(), &at.sin_addr);
  const int on = 1;
  if (fd && tcp)
    setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  return fd
                 && bind(fd.get(), reinterpret_cast<const sockaddr*>(&at),
                         sizeof at)
                        == 0
             ? 0
             : errno;
}

port_readings read_port(const checked_host& host, const std::string& protocol,
                        const std::string& address, uint16_t port) {
  port_readings result{
      protocol, port, try_to_bind(protocol, address, port), {}, 0};
  if (result.error == EADDRINUSE) {
    const auto holder = find_port_holder(host.proc, protocol, port);
    result.pid = holder.pid;
    if (holder.pid != 0)
      result.holder =
          "pid " + std::to_string(holder.pid) + " (" + holder.program + ")";
  }
  return result;
}

std::string range_text(const port_range& x) {
  return std::to_string(x.first)
         + (x.last == x.first ? "" : "-" + std::to_string(x.last));
}

bool do_overlap(const port_range& a, const port_range& b) {
  return a.first <= b.last && b.first <= a.last;
}

bool is_reserved(const port_range& wanted,
                 const std::vector<port_range>& reserved) {
  auto next = wanted.first;
  // The kernel tells them in order, and none overlaps another.
  for (const auto& x : reserved)
    if (x.first <= next && next <= x.last)
      next = x.last + 1;
  return next > wanted.last;
}

std::string kernel_setting(const checked_host& host, const char* name) {
  auto text =
      read_small_file(host.proc + "/sys/net/ipv4/" + name, longest_port_text)
          .value_or("");
  text.erase(text.find_last_not_of(" \n") + 1);
  return text;
}

ephemeral_readings read_ephemeral_ports(const checked_host& host) {
  ephemeral_readings result;
  std::istringstream range{kernel_setting(host, "ip_local_port_range")};
  range >> result.range.first >> result.range.last;
  result.reserved_text = kernel_setting(host, "ip_local_reserved_ports");
  result.reserved = parse_port_ranges(result.reserved_text);
  return result;
}

} // namespace

port_range ports_of_domain(unsigned domain) {
  const auto first = first_dds_port + domain_ports * domain;
  return {first, std::min(first + domain_ports - 1, 65535U)};
}

port_range public_ports(unsigned domain) {
  const auto first = first_dds_port + domain_ports * domain;
  return {first, std::min(first + public_places, 65535U)};
}

std::vector<port_range> parse_port_ranges(const std::string& text) {
  std::vector<port_range> result;
  std::istringstream parts{text};
  std::string part;
  while (std::getline(parts, part, ',')) {
    port_range one{0, 0};
    char dash = 0;
    std::istringstream words{part};
    if (!(words >> one.first))
      continue;
    if (!(words >> dash >> one.last))
      one.last = one.first;
    result.push_back(one);
  }
  return result;
}

finding judge_port(const port_readings& readings, bool vital) {
  const auto name =
      readings.protocol + " port " + std::to_string(readings.port);
  const auto option = vital ? "--port" : "--discovery-port";
  if (readings.error == 0)
    return {judgement::ok, name + " is free"};
  const auto why =
      vital ? std::string{"a node cannot start; or give it another --port"}
            : std::string{"a coordinator cannot start, and a member takes "
                          "another port; or give it another --discovery-port"};
  if (readings.error != EADDRINUSE)
    return {judgement::broken, name + ": " + std::strerror(readings.error), why,
            std::string{"roscell node "} + option + " 0"};
  return {
      vital ? judgement::broken : judgement::warning,
      name + " is taken by "
          + (readings.holder.empty() ? "a program that this user may not see"
                                     : readings.holder),
      why,
      readings.pid != 0
          ? "ps -o pid,user,lstart,args -p " + std::to_string(readings.pid)
          : "sudo ss -lntup 'sport = :" + std::to_string(readings.port) + "'"};
}

finding judge_node_there(const std::string& name, const std::string& address) {
  return {judgement::warning, "node '" + name + "' has them, at " + address,
          "it runs already: what it knows is checked when it is named. "
          "Another node of this host needs another --port",
          "roscell doctor --to " + shell_word(address)};
}

finding judge_ephemeral(const ephemeral_readings& readings,
                        const std::vector<port_range>& wanted) {
  const auto given = range_text(readings.range);
  std::string inside;
  for (const auto& x : wanted)
    if (do_overlap(x, readings.range) && !is_reserved(x, readings.reserved))
      inside += (inside.empty() ? "" : ",") + range_text(x);
  if (readings.range.last == 0)
    return {judgement::skipped, "the kernel does not report its port range"};
  if (inside.empty())
    return {judgement::ok,
            "any program may get " + given + ", none of ROSCell's"};
  return {
      judgement::warning,
      "any program may get " + given + ", with " + inside + " of ROSCell",
      "a connection of another program may hold a port by chance, and then "
      "a node does not start, or is not found",
      "sudo sysctl -w net.ipv4.ip_local_reserved_ports="
          + (readings.reserved_text.empty() ? "" : readings.reserved_text + ",")
          + inside};
}

std::vector<unsigned> program_ports(unsigned domain) {
  // D1 and PG of RTPS 2.3, 9.6.1.1; Fast DDS tries the first and 100 more.
  constexpr unsigned first_unicast = 10;
  constexpr unsigned participant_ports = 2;
  constexpr unsigned tries = 101;
  const auto range = ports_of_domain(domain);
  std::vector<unsigned> result;
  for (unsigned i = 0; i < tries; ++i) {
    const auto port = range.first + first_unicast + participant_ports * i;
    if (port < range.last)
      result.push_back(port);
  }
  return result;
}

finding judge_domain(unsigned domain, const std::set<unsigned>& bound) {
  const auto tried = program_ports(domain);
  const auto used = std::count_if(tried.begin(), tried.end(), [&](auto port) {
    return bound.count(port) + bound.count(port + 1) > 0;
  });
  const auto all = static_cast<std::ptrdiff_t>(tried.size());
  const auto seen = std::to_string(used) + " of the " + std::to_string(all)
                    + " ports that a ROS 2 program tries in domain "
                    + std::to_string(domain) + " are in use";
  constexpr std::ptrdiff_t spare = 21; // Of 101: warned from 81 on.
  if (used <= all - spare)
    return {judgement::ok, seen};
  return {
      used < all ? judgement::warning : judgement::broken, seen,
      "a ROS 2 program that finds none of them free runs and hears nothing, "
      "without a word of it",
      "ss -uanp 'sport >= :" + std::to_string(tried.front())
          + " and sport <= :" + std::to_string(tried.back() + 1) + "'"};
}

findings check_node_ports(const checked_host& host) {
  const auto at = checked_address(host.interface, list_interfaces());
  const auto address = at ? at->address : "0.0.0.0";
  const auto& config = host.config;
  if (host.node_runs)
    return {{judgement::ok, "they are in use by the node"}};
  findings result;
  if (config.http_port != 0)
    for (const auto* protocol : {"tcp", "udp"})
      result.push_back(judge_port(
          read_port(host, protocol, address, config.http_port), true));
  if (is_broken(result))
    if (const auto name = node_at(address, config.http_port); !name.empty())
      return {judge_node_there(name, address + ":"
                                         + std::to_string(config.http_port))};
  if (config.discovery_port != 0)
    result.push_back(judge_port(
        read_port(host, "udp", address, config.discovery_port), false));
  return result;
}

findings check_dds_ports(const checked_host& host) {
  const auto& config = host.config;
  const auto skills = ports_of_domain(config.ros_domain_id);
  std::vector<port_range> wanted{skills, public_ports(config.public_domain_id)};
  // What a running node has, nobody else gets, and it may be any by intention.
  for (const unsigned port : {config.http_port, config.discovery_port})
    if (port != 0 && !host.node_runs)
      wanted.push_back({port, port});
  return {judge_domain(config.ros_domain_id, bound_udp_ports(host.proc)),
          judge_ephemeral(read_ephemeral_ports(host), wanted)};
}

} // namespace roscell::cli
