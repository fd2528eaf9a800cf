#pragma once

#include "messages/failure.hpp"
#include "messages/inside/agent.hpp"
#include "messages/inside/link.hpp"
#include "messages/inside/runtime.hpp"
#include "messages/insight/reach.hpp"
#include "messages/node.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// Asks where the node stands.
struct membership_query {
  static constexpr auto fields() {
    return field_list{};
  }
};

struct membership_state {
  node_identity identity;
  node_state state = node_state::independent;
  std::string cell;
  std::string coordinator;      ///< Address of the coordinator's HTTP port.
  std::string discovery_server; ///< Of the cell, as "host:port".
  std::vector<join_failure> joining; ///< At most one; empty: it does not try.
  /// What a ROS 2 program on this node needs; empty: it is in no cell.
  std::map<std::string, std::string> environment;

  static constexpr auto fields() {
    return field_list{
        required("identity", &membership_state::identity),
        required("state", &membership_state::state),
        required("cell", &membership_state::cell),
        required("coordinator", &membership_state::coordinator),
        required("discovery_server", &membership_state::discovery_server),
        required("joining", &membership_state::joining),
        required("environment", &membership_state::environment)};
  }
};

/// Joins the cell of a given discovery server, now and after every loss.
struct join_cell {
  std::string discovery_server; ///< "host:port", an IPv4 address or a name.

  static constexpr auto fields() {
    return field_list{
        required("discovery_server", &join_cell::discovery_server)};
  }
};

/// Asks the coordinators that are visible for a place, now and whenever one
/// appears, until the node is in a cell.
struct seek_cell {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// What of a node's belonging outlives its process.
struct membership_record {
  /// How the node was started: the address given, "wait" or nothing. A node
  /// that is started in another way forgets the rest.
  std::string configured;
  std::string discovery_server; ///< Of its cell; empty: it was released.
  std::string cell;
  join_origin origin = join_origin::given;
  std::string cell_uuid; ///< Empty: its coordinator has not told it.
  /// Of the node's own discovery server, and its UDP port; at most one.
  std::vector<discovery_place> discovery;
  uint16_t discovery_port = 0;
  /// The cell that gave its id.
  std::string server_cell;

  static constexpr auto fields() {
    return field_list{
        required("configured", &membership_record::configured),
        required("discovery_server", &membership_record::discovery_server),
        required("cell", &membership_record::cell),
        required("origin", &membership_record::origin),
        optional("cell_uuid", &membership_record::cell_uuid),
        one_or_many("discovery", &membership_record::discovery),
        optional("discovery_port", &membership_record::discovery_port),
        optional("server_cell", &membership_record::server_cell)};
  }
};

/// Leaves in order, telling the coordinator.
struct leave_cell {
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("reason", &leave_cell::reason)};
  }
};

// Finding out why nobody answers at the address of a discovery server.

/// Asks for the IPv4 address of a host.
struct resolve_host {
  std::string host; ///< A name, or an address already.

  static constexpr auto fields() {
    return field_list{required("host", &resolve_host::host)};
  }
};

struct host_resolved {
  std::string address; ///< In numbers.

  static constexpr auto fields() {
    return field_list{required("address", &host_resolved::address)};
  }
};

/// Asks who is at an address where a discovery server should be.
struct probe_server {
  std::string address; ///< IPv4, in numbers.
  uint16_t port = 0;   ///< UDP of the discovery server.

  static constexpr auto fields() {
    return field_list{required("address", &probe_server::address),
                      required("port", &probe_server::port)};
  }
};

/// A TCP port, and who is behind it.
struct probed_port {
  uint16_t port = 0;
  port_answer answer = port_answer::silent;
  std::vector<node_hello> hello; ///< One if `found`. A hint: nothing is proved.

  static constexpr auto fields() {
    return field_list{required("port", &probed_port::port),
                      required("answer", &probed_port::answer),
                      required("hello", &probed_port::hello)};
  }
};

struct server_probed {
  port_answer discovery = port_answer::silent; ///< Of the UDP port.
  std::vector<probed_port> tcp; ///< The same number, then the usual HTTP port.

  static constexpr auto fields() {
    return field_list{required("discovery", &server_probed::discovery),
                      required("tcp", &server_probed::tcp)};
  }
};

/// INTERNAL to the join diagnoser: what came of a question.
struct diagnosis_settled {
  uint64_t question = 0;
  std::string address;  ///< Of a host, if one was asked for.
  server_probed probed; ///< Else this.
  failure problem;      ///< Why the host has no address, if it has none.

  static constexpr auto fields() {
    return field_list{required("question", &diagnosis_settled::question),
                      required("address", &diagnosis_settled::address),
                      required("scouted", &diagnosis_settled::probed),
                      required("problem", &diagnosis_settled::problem)};
  }
};

} // namespace roscell
