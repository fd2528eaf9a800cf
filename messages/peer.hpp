#pragma once

#include "messages/failure.hpp"
#include "messages/formation.hpp"
#include "messages/inside/introspection.hpp"

#include <array>
#include <string>
#include <vector>

/// What coordinators say to each other, and what a node is told when it shall
/// change its cell.
namespace roscell {

/// How a node came to its cell.
enum class join_origin {
  given,      ///< It was started with the address of the discovery server.
  discovered, ///< It asked for a slot; it may be moved to balance cells.
  chosen,     ///< An operator brought it in.
};

constexpr auto enum_words(join_origin) {
  return std::array<std::string_view, 3>{"given", "discovered", "chosen"};
}

/// Where a cell is to be found.
struct cell_address {
  std::string cell;
  std::string coordinator;
  std::string address;          ///< Of the coordinator's HTTP port.
  std::string discovery_server; ///< "ip:port"

  static constexpr auto fields() {
    return field_list{
        required("cell", &cell_address::cell),
        required("coordinator", &cell_address::coordinator),
        required("address", &cell_address::address),
        required("discovery_server", &cell_address::discovery_server)};
  }
};

/// A coordinator has a row for this node. Of two coordinators that claim the
/// same UUID as active, the one with the higher epoch is right.
struct member_claim {
  std::string name;
  std::string uuid;
  int64_t epoch = 0;
  bool active = false;

  static constexpr auto fields() {
    return field_list{required("name", &member_claim::name),
                      required("uuid", &member_claim::uuid),
                      required("epoch", &member_claim::epoch),
                      required("active", &member_claim::active)};
  }
};

/// Coordinator to coordinator, a notice, first of all: what my cell is.
struct cell_standing {
  static constexpr const char* type = "cell_standing";
  cell_address place;
  std::string uuid; ///< Of the coordination node.
  int64_t incarnation = 0;
  int64_t size = 0;      ///< Active, reserved and departing rows.
  bool rebalance = true; ///< Takes part in evening out.
  std::vector<member_claim> members;
  std::string cell_uuid; ///< Of the cell.
  /// Of its discovery server, and the ROS domain; negative: an older peer.
  int64_t server_id = -1;
  int64_t domain_id = -1;

  static constexpr auto fields() {
    return field_list{required("place", &cell_standing::place),
                      required("uuid", &cell_standing::uuid),
                      required("incarnation", &cell_standing::incarnation),
                      required("size", &cell_standing::size),
                      required("rebalance", &cell_standing::rebalance),
                      required("members", &cell_standing::members),
                      optional("cell_uuid", &cell_standing::cell_uuid),
                      optional("server_id", &cell_standing::server_id),
                      optional("domain_id", &cell_standing::domain_id)};
  }
};

/// Coordinator to coordinator, a notice: what has changed since.
struct cell_changed {
  static constexpr const char* type = "cell_changed";
  int64_t size = 0;
  std::vector<member_claim> changed;
  std::vector<std::string> gone; ///< UUIDs.

  static constexpr auto fields() {
    return field_list{required("size", &cell_changed::size),
                      optional("changed", &cell_changed::changed),
                      optional("gone", &cell_changed::gone)};
  }
};

/// A node asks for a slot in the smallest cell. Asked of any coordinator; the
/// one with the lowest UUID answers.
struct place_request {
  static constexpr const char* type = "place_request";
  std::string name;
  std::string uuid;
  int64_t epoch = 0;

  static constexpr auto fields() {
    return field_list{required("name", &place_request::name),
                      required("uuid", &place_request::uuid),
                      required("epoch", &place_request::epoch)};
  }
};

struct place_granted {
  static constexpr const char* type = "place_granted";
  cell_address place;

  static constexpr auto fields() {
    return field_list{required("place", &place_granted::place)};
  }
};

/// Coordinator to coordinator: keep a place in your cell for this node.
struct place_reservation {
  static constexpr const char* type = "place_reservation";
  std::string name;
  std::string uuid;
  int64_t epoch = 0;
  int64_t hold_ms = 0; ///< For so long.

  static constexpr auto fields() {
    return field_list{required("name", &place_reservation::name),
                      required("uuid", &place_reservation::uuid),
                      required("epoch", &place_reservation::epoch),
                      required("hold_ms", &place_reservation::hold_ms)};
  }
};

struct place_reserved {
  static constexpr const char* type = "place_reserved";
  int64_t size = 0; ///< Of the cell, with this place.

  static constexpr auto fields() {
    return field_list{required("size", &place_reserved::size)};
  }
};

/// Coordinator to coordinator: even the cells out by moving so many of your
/// members, none with instances and none that was put there on purpose.
struct member_surrender {
  static constexpr const char* type = "member_surrender";
  std::string target; ///< Name of the cell.
  int64_t count = 0;

  static constexpr auto fields() {
    return field_list{required("target", &member_surrender::target),
                      required("count", &member_surrender::count)};
  }
};

struct members_surrendered {
  static constexpr const char* type = "members_surrendered";
  std::vector<std::string> nodes; ///< That have moved.

  static constexpr auto fields() {
    return field_list{required("nodes", &members_surrendered::nodes)};
  }
};

/// Tells a node to change its registration. A member hears it over the session
/// of its coordinator; an independent or orphaned node at its REST API, with a
/// proof made with the site token.
struct registration_switch {
  static constexpr const char* type = "registration_switch";
  std::string transfer; ///< Repeating it is harmless.
  std::string node;
  std::string uuid;
  int64_t epoch = 0; ///< The node's present one; any other is refused.
  join_origin origin = join_origin::chosen;
  std::vector<cell_address> target; ///< One; none: become independent.
  std::string nonce;                ///< That the node has given out; REST only.
  std::string proof;                ///< REST only.

  static constexpr auto fields() {
    return field_list{required("transfer", &registration_switch::transfer),
                      required("node", &registration_switch::node),
                      required("uuid", &registration_switch::uuid),
                      required("epoch", &registration_switch::epoch),
                      required("origin", &registration_switch::origin),
                      one_or_many("target", &registration_switch::target),
                      optional("nonce", &registration_switch::nonce),
                      optional("proof", &registration_switch::proof)};
  }
};

/// Reply to `registration_switch`: the node has written it down and goes.
struct switch_accepted {
  static constexpr const char* type = "switch_accepted";
  int64_t epoch = 0; ///< Raised.

  static constexpr auto fields() {
    return field_list{required("epoch", &switch_accepted::epoch)};
  }
};

/// Asks a node for what a proof must contain.
struct registration_query {
  static constexpr const char* type = "registration_query";
  std::string nonce; ///< Of who asks.
  std::string proof; ///< That he has the site token, over the nonce.

  static constexpr auto fields() {
    return field_list{optional("nonce", &registration_query::nonce),
                      optional("proof", &registration_query::proof)};
  }
};

struct registration_challenge {
  static constexpr const char* type = "registration_challenge";
  std::string node;
  std::string uuid;
  int64_t epoch = 0;
  std::string state; ///< A word of `node_state`.
  std::string nonce; ///< Good for one switch within 10 s.
  std::string
      proof; ///< Of node, UUID, epoch and state, over the asker's nonce.

  static constexpr auto fields() {
    return field_list{required("node", &registration_challenge::node),
                      required("uuid", &registration_challenge::uuid),
                      required("epoch", &registration_challenge::epoch),
                      required("state", &registration_challenge::state),
                      required("nonce", &registration_challenge::nonce),
                      optional("proof", &registration_challenge::proof)};
  }
};

/// Sends a switch to the REST API of a node.
struct switch_node {
  std::string address; ///< "ip:port"
  registration_switch order;

  static constexpr auto fields() {
    return field_list{required("address", &switch_node::address),
                      required("order", &switch_node::order)};
  }
};

/// Asks a node at its REST API to prove that it is the one that it announces.
struct prove_status {
  std::string address; ///< "ip:port"
  std::string node;
  std::string uuid;

  static constexpr auto fields() {
    return field_list{required("address", &prove_status::address),
                      required("node", &prove_status::node),
                      required("uuid", &prove_status::uuid)};
  }
};

/// It has, with the site token.
struct status_proved {
  node_identity identity;
  node_state state = node_state::independent;

  static constexpr auto fields() {
    return field_list{required("identity", &status_proved::identity),
                      required("state", &status_proved::state)};
  }
};

/// INTERNAL to the registration client: what a node has answered.
struct node_answered {
  uint64_t call = 0;
  std::string body; ///< JSON; empty if there is none.
  failure problem;  ///< Why there is none.

  static constexpr auto fields() {
    return field_list{required("call", &node_answered::call),
                      required("body", &node_answered::body),
                      required("problem", &node_answered::problem)};
  }
};

} // namespace roscell
