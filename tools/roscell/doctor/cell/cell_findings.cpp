#include "tools/roscell/doctor/cell/cell_findings.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/network/ports.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cmath>

namespace roscell::cli {

findings judge_versions(const reached_cell& cell) {
  findings result;
  const auto base = cell.nodes.find(cell.coordinator);
  if (base == cell.nodes.end())
    return result;
  const auto& version = base->second.version;
  for (const auto& [name, x] : cell.nodes)
    if (x.version != version)
      result.push_back(
          named_finding("cell-versions", "cell",
                        {judgement::warning,
                         name + " is of version " + x.version
                             + ", its coordinator of " + version,
                         "what only one of them knows cannot be used",
                         on_host(host_of(x), "roscell --version")}));
  if (result.empty())
    result.push_back(
        named_finding("cell-versions", "cell",
                      {judgement::ok, std::to_string(cell.nodes.size())
                                          + " nodes of version " + version}));
  return result;
}

namespace {

// A frame of a camera; what is more makes ages wrong, and transforms fail.
constexpr double tolerable_ms = 33;

/// How far `x` is ahead of `base` for sure, whichever way.
double sure_difference(const clock_reading& x, const clock_reading& base) {
  return std::abs(x.offset_ms - base.offset_ms) - x.uncertainty_ms
         - base.uncertainty_ms;
}

/// By whose clock the others are judged: one that more than half of all nodes
/// agree with, the coordinator's if it is one of these, and its own if no clock
/// is. null without a coordinator's.
const clock_reading* base_of(const std::vector<clock_reading>& all,
                             const std::string& coordinator) {
  const clock_reading* own = nullptr;
  const clock_reading* most = nullptr;
  for (const auto& x : all) {
    const auto agree = std::count_if(all.begin(), all.end(), [&](auto& y) {
      return sure_difference(x, y) <= tolerable_ms;
    });
    const bool by_most = 2 * static_cast<size_t>(agree) > all.size();
    if (x.node == coordinator)
      own = &x;
    if (by_most && (!most || x.node == coordinator))
      most = &x;
  }
  return own && most ? most : own;
}

} // namespace

findings judge_clocks(const std::vector<clock_reading>& all,
                      const reached_cell& cell) {
  constexpr double hopeless_ms = 1000;
  findings result;
  const auto* base = base_of(all, cell.coordinator);
  if (!base)
    return result;
  const bool is_own = base->node == cell.coordinator;
  double most = 0;
  for (const auto& x : all) {
    const auto offset = x.offset_ms - base->offset_ms;
    const auto sure = sure_difference(x, *base);
    most = std::max(most, std::abs(offset));
    const auto host = cell.nodes.find(x.node);
    if (sure <= tolerable_ms || host == cell.nodes.end())
      continue;
    result.push_back(named_finding(
        "cell-clocks", "cell",
        {sure > hopeless_ms ? judgement::broken : judgement::warning,
         x.node + "'s clock is " + format_number(std::abs(offset) / 1000)
             + " s " + (offset > 0 ? "ahead of" : "behind") + " "
             + (is_own ? "the coordinator's" : "that of most nodes"),
         "ages of data are wrong, and programs drop transforms and messages as "
         "too old or from the future",
         on_host(host_of(host->second), "sudo chronyc makestep")}));
  }
  if (result.empty())
    result.push_back(named_finding(
        "cell-clocks", "cell",
        {judgement::ok, "clocks differ by " + format_number(most)
                            + " ms at most, as far as can be told"}));
  return result;
}

namespace {

/// What a way is for.
struct path_text {
  const char* protocol;
  const char* name;
  const char* matters;
};

/// In the order of `reach_way`.
constexpr path_text words[] = {
    {"tcp", "sessions",
     "a node cannot join, or its coordinator cannot call it"},
    {"udp", "heartbeats", "a node is taken for lost again and again"},
    {"udp", "discovery", "skills and ROS 2 programs do not find each other"},
    {"udp", "data", "no topic that both nodes share brings any data"},
    {"udp", "large data",
     "images do not arrive: fragments of datagrams are lost on the way"},
    {"udp", "multicast",
     "nodes that are started without --join do not find this one"}};

const path_text& texts_of_path(reach_way way) {
  return words[static_cast<size_t>(way)];
}

/// The ports that a firewall has to let through for a row.
std::string ports_of(const reach_row& x) {
  if (x.way < reach_way::data)
    return std::to_string(x.port);
  const auto domain = (x.port - ports_of_domain(0).first)
                      / (ports_of_domain(1).first - ports_of_domain(0).first);
  const auto range = ports_of_domain(domain);
  return std::to_string(range.first) + "-" + std::to_string(range.last);
}

std::string remedy_of(const reach_row& x, const std::string& from,
                      const std::string& to) {
  switch (x.answer) {
  case port_answer::unreachable:
    return on_host(from, "ip route get " + shell_word(to));
  case port_answer::closed:
  case port_answer::unauthenticated_peer:
    return on_host(to, "roscell doctor --only ports");
  default:
    break;
  }
  if (x.way == reach_way::large)
    return on_host(from, "tracepath -n " + shell_word(to));
  if (x.way == reach_way::multicast)
    return on_host(to, "sudo roscell doctor --only multicast,firewall");
  return on_host(to, "sudo nft insert rule inet filter input ip saddr "
                         + shell_word(from) + " "
                         + texts_of_path(x.way).protocol + " dport "
                         + ports_of(x) + " accept");
}

std::string meaning_of(const reach_row& x) {
  switch (x.answer) {
  case port_answer::silent:
    return "nothing comes back";
  case port_answer::closed:
    return "nobody listens, or a firewall refuses";
  case port_answer::unreachable:
    return "there is no way to the host";
  default:
    return "something else answers";
  }
}

/// Members use nothing of each other but data; each may be asked to coordinate.
bool is_used(const reach_row& x, const std::string& from,
             const std::string& coordinator) {
  return x.way == reach_way::data || x.way == reach_way::large
         || (x.way != reach_way::multicast
             && (from == coordinator || x.node == coordinator));
}

finding judge_row(const reach_row& x, const std::string& from,
                  const reached_cell& cell) {
  const auto& way = texts_of_path(x.way);
  const bool used = is_used(x, from, cell.coordinator);
  std::string matters = way.matters;
  if (!used && x.way != reach_way::multicast)
    matters = "nothing needs it now; it will when one of the two coordinates "
              "the other";
  return {used ? judgement::broken : judgement::warning,
          from + " -> " + x.node + ": " + way.name + " by " + way.protocol
              + " port " + std::to_string(x.port) + ": " + meaning_of(x),
          matters,
          remedy_of(x, host_of(cell.nodes.at(from)),
                    host_of(cell.nodes.at(x.node)))};
}

bool is_loopback(const reached_cell& cell, const std::string& node) {
  return host_of(cell.nodes.at(node)).rfind("127.", 0) == 0;
}

/// Whether another program may have the port of a host's first skills.
bool is_of_others(const reach_row& x, const reach_opened& to) {
  return x.way == reach_way::data && x.port != to.data_port
         && (x.answer == port_answer::closed
             || x.answer == port_answer::unauthenticated_peer);
}

/// What comes of another problem that is told is not told as well.
bool is_consequence(const reach_row& x, const std::vector<reach_row>& all,
                    const reach_opened& to) {
  return x.way >= reach_way::data
         && std::any_of(all.begin(), all.end(), [&](const auto& other) {
              return other.node == x.node && other.way == reach_way::data
                     && other.answer != port_answer::found
                     && !is_of_others(other, to)
                     && (x.way != reach_way::data || other.port < x.port);
            });
}

/// "arm reaches base, leg (0.2 to 0.9 ms)"
finding all_reached(const reach_report& reported,
                    const std::vector<std::string>& names) {
  double least = -1;
  double most = -1;
  for (const auto& x : reported.rows)
    if (x.round_trip_ms >= 0) {
      least = least < 0 ? x.round_trip_ms : std::min(least, x.round_trip_ms);
      most = std::max(most, x.round_trip_ms);
    }
  return {judgement::ok, reported.node + " reaches " + joined(names, ", ")
                             + " (" + format_number(least) + " to "
                             + format_number(most) + " ms)"};
}

} // namespace

std::string host_of(const reach_opened& x) {
  const auto at = parse_socket_address(x.address);
  return at ? at->address : x.address;
}

findings judge_reach(const reach_report& reported, const reached_cell& cell) {
  findings result;
  std::map<std::string, bool> all_ways;
  if (cell.nodes.count(reported.node) == 0)
    return result;
  for (const auto& x : reported.rows) {
    if (cell.nodes.count(x.node) == 0
        || (x.way == reach_way::multicast && is_loopback(cell, x.node)))
      continue;
    auto& reached = all_ways.emplace(x.node, true).first->second;
    const auto& to = cell.nodes.at(x.node);
    if (x.answer == port_answer::found || is_of_others(x, to)
        || is_consequence(x, reported.rows, to))
      continue;
    reached = false;
    result.push_back(
        named_finding("reach", "cell", judge_row(x, reported.node, cell)));
  }
  std::vector<std::string> names;
  for (const auto& [name, reached] : all_ways)
    if (reached)
      names.push_back(name);
  if (!names.empty())
    result.push_back(
        named_finding("reach", "cell", all_reached(reported, names)));
  return result;
}

} // namespace roscell::cli
