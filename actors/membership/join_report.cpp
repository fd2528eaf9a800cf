#include "actors/membership/join_report.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "actors/membership/limits.hpp"

#include <algorithm>

namespace roscell {

join_report::join_report() : pause_{limits::membership::complaint_pause} {
  // nop
}

void join_report::begin(const std::string& address, int64_t now_unix_ms) {
  if (rows_.empty())
    rows_.emplace_back();
  auto& row = rows_.front();
  if (row.address != address) {
    row.address = address;
    row.problem.clear();
    row.hint.clear();
  }
  ++row.attempts;
  row.tried_unix_ms = now_unix_ms;
}

bool join_report::note(const std::string& problem, const std::string& hint,
                       time_point now) {
  if (rows_.empty())
    return false;
  rows_.front().problem = problem;
  rows_.front().hint = hint;
  // Who provokes ever new problems is told of like any other.
  const bool news = reported_.size() < limits::membership::complaints
                    && reported_.insert(problem).second;
  if (!news && now < next_)
    return false;
  if (!news || reported_.size() == 1) {
    next_ = now + pause_;
    pause_ = std::min<std::chrono::milliseconds>(
        2 * pause_, limits::membership::longest_complaint_pause);
  }
  return true;
}

void join_report::clear() {
  *this = join_report{};
}

namespace {

/// One question and all that was found out about it.
struct evidence {
  const join_question& asked;
  const server_probed& found;

  std::string host() const {
    return asked.address.substr(0, asked.address.find(':'));
  }

  std::string udp() const {
    return "UDP port " + std::to_string(asked.port);
  }
};

std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

std::string of_cell(const node_hello& who) {
  return who.cell.empty() ? std::string{} : " of cell " + quoted(who.cell);
}

/// "TCP port 8420", or "TCP ports 11811 and 8420".
std::string tcp_ports(const server_probed& found) {
  std::string numbers;
  for (const auto& x : found.tcp)
    numbers += (numbers.empty() ? "" : " and ") + std::to_string(x.port);
  return (found.tcp.size() == 1 ? "TCP port " : "TCP ports ") + numbers;
}

const probed_port* find_tcp(const server_probed& found, port_answer answer) {
  const auto i =
      std::find_if(found.tcp.begin(), found.tcp.end(),
                   [=](const auto& x) { return x.answer == answer; });
  return i == found.tcp.end() ? nullptr : &*i;
}

/// Where the cell of that node is joined, as an option.
std::string join_option(const node_hello& who) {
  return "use --join " + who.discovery_server;
}

// -- a node has introduced itself --------------------------------------------

join_diagnosis silent_server(const evidence& x, const node_hello& who,
                             uint16_t http_port) {
  const auto answers = "coordinator " + quoted(who.node) + of_cell(who)
                       + " answers on TCP port " + std::to_string(http_port)
                       + " of " + x.host() + ", but its discovery server ";
  if (x.found.discovery == port_answer::silent)
    return {answers + "does not answer on " + x.udp()
                + ": a firewall drops UDP",
            "let " + x.udp() + " and its answers through, there and here"};
  return {answers + "refuses " + x.udp() + ": a firewall rejects UDP",
          "let " + x.udp() + " through on " + x.host()};
}

join_diagnosis mute_server(const evidence& x, const node_hello& who) {
  return {"the discovery server of coordinator " + quoted(who.node)
              + of_cell(who) + " answers on " + x.udp()
              + ", but what it announces does not arrive",
          "let UDP in both directions through the firewalls between " + x.host()
              + " and this node"};
}

join_diagnosis found_coordinator(const evidence& x, const node_hello& who,
                                 uint16_t http_port) {
  const auto server = parse_host_address(who.discovery_server);
  if (server && server->port != x.asked.port) {
    if (http_port == x.asked.port)
      return {"port " + std::to_string(http_port)
                  + " is the HTTP port of coordinator " + quoted(who.node)
                  + of_cell(who) + ", not its discovery server",
              join_option(who)};
    return {"coordinator " + quoted(who.node) + of_cell(who) + " at " + x.host()
                + " has its discovery server on UDP port "
                + std::to_string(server->port) + ", not on "
                + std::to_string(x.asked.port),
            join_option(who)};
  }
  return x.found.discovery == port_answer::found
             ? mute_server(x, who)
             : silent_server(x, who, http_port);
}

join_diagnosis found_member(const evidence& x, const node_hello& who) {
  const auto is = "node " + quoted(who.node) + " at " + x.host() + " is ";
  if (who.discovery_server.empty())
    return {is + "in no cell, and coordinates none",
            "give the address of the coordinator, or start that node with "
            "--coordinator"};
  const auto where =
      who.coordinator.empty() ? "" : ", which is at " + who.coordinator;
  return {is + "a member" + of_cell(who) + ", not its coordinator" + where,
          join_option(who)};
}

// -- nobody has --------------------------------------------------------------

join_diagnosis no_host(const evidence& x) {
  if (x.found.discovery == port_answer::unreachable
      || find_tcp(x.found, port_answer::unreachable) != nullptr)
    return {"there is no way to " + x.host()
                + ": the network says that it cannot be reached",
            "check the address, and --interface of this node"};
  return {x.host() + " does not answer at all, neither on " + x.udp()
              + " nor on " + tcp_ports(x.found),
          "is the address right, and is that host up? A firewall may drop "
          "everything"};
}

join_diagnosis no_listener(const evidence& x) {
  constexpr auto hint =
      "is the coordinator running there? One that was started "
      "with --discovery-port is joined at that port";
  if (x.found.discovery == port_answer::silent)
    return {x.udp() + " of " + x.host() + " does not answer, and nothing "
                + "listens on " + tcp_ports(x.found),
            hint};
  return {"nothing listens on " + x.udp() + " of " + x.host() + ", nor on "
              + tcp_ports(x.found),
          hint};
}

join_diagnosis other_server(const evidence& x) {
  if (x.found.discovery == port_answer::unauthenticated_peer)
    return {"what answers on " + x.udp() + " of " + x.host()
                + " is DDS, but no discovery server that ROS 2 knows",
            "give the address of a coordinator of ROSCell"};
  return {"a discovery server answers on " + x.udp() + " of " + x.host()
              + ", but no coordinator of ROSCell announces itself there",
          "give the address of a coordinator of ROSCell; the server may be "
          "one of ROS 2 alone"};
}

join_diagnosis other_program(const evidence& x, const probed_port& port) {
  return {"no discovery server answers on " + x.udp() + " of " + x.host()
              + ", and what listens on TCP port " + std::to_string(port.port)
              + " is no node of ROSCell, or one of an older version",
          "give the address of a coordinator of ROSCell"};
}

} // namespace

join_diagnosis diagnose(const join_question& asked,
                        const server_probed& found) {
  const evidence x{asked, found};
  if (const auto* port = find_tcp(found, port_answer::found)) {
    const auto& who = port->hello.front();
    return who.role == node_role::coordinator
               ? found_coordinator(x, who, port->port)
               : found_member(x, who);
  }
  if (found.discovery == port_answer::found
      || found.discovery == port_answer::unauthenticated_peer)
    return other_server(x);
  if (const auto* port = find_tcp(found, port_answer::unauthenticated_peer))
    return other_program(x, *port);
  if (found.discovery == port_answer::closed
      || find_tcp(found, port_answer::closed) != nullptr)
    return no_listener(x);
  return no_host(x);
}

join_diagnosis diagnose_session(const std::string& session,
                                const std::string& reason) {
  return {reason, "the discovery server answers: let TCP and UDP of " + session
                      + " through the firewall too"};
}

join_diagnosis diagnose_solitude(int64_t public_domain) {
  return {"no coordinator is visible on the public domain "
              + std::to_string(public_domain),
          "is one running with the same --public-domain? Where multicast does "
          "not reach it, name it with --peer, or its cell with --join"};
}

} // namespace roscell
