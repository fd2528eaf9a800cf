#pragma once

#include "messages/instance.hpp"
#include "messages/skill.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace roscell {

enum class node_role { primary, coordinator };

constexpr auto enum_words(node_role) {
  return std::array<std::string_view, 2>{"primary", "coordinator"};
}

/// Where a node stands; the diagram is in docs/protocols.md.
enum class node_state { independent, joining, member, switching, orphaned };

constexpr auto enum_words(node_state) {
  return std::array<std::string_view, 5>{"independent", "joining", "member",
                                         "switching", "orphaned"};
}

/// Who a node is, for good: what it says of itself at every handshake.
struct node_identity {
  std::string name;
  std::string uuid;    ///< Made at the first start, kept in the data directory.
  int64_t epoch = 0;   ///< Registration epoch, raised before every switch.
  std::string address; ///< "ip:port" of its HTTP port.

  static constexpr auto fields() {
    return field_list{required("name", &node_identity::name),
                      required("uuid", &node_identity::uuid),
                      required("epoch", &node_identity::epoch),
                      required("address", &node_identity::address)};
  }
};

/// Where the discovery server of a member belongs.
struct discovery_place {
  int64_t server_id = -1; ///< Its own id, unique in the cell.
  int64_t domain_id = 0;  ///< The ROS domain of the cell.
  std::string remote;     ///< "ip:port" of the coordinator's server.
  int64_t remote_id = 0;  ///< Id of that one.

  static constexpr auto fields() {
    return field_list{required("server_id", &discovery_place::server_id),
                      required("domain_id", &discovery_place::domain_id),
                      required("remote", &discovery_place::remote),
                      required("remote_id", &discovery_place::remote_id)};
  }
};

/// Counters of one actor, as the spawn function keeps them.
struct actor_row {
  std::string name;
  uint64_t id = 0;
  /// Id of the actor that spawned it, which may have ended; 0: the node itself.
  uint64_t parent = 0;
  uint64_t messages = 0;   ///< Handled so far.
  uint64_t mailbox = 0;    ///< Waiting now.
  uint64_t busy_us = 0;    ///< Sum of the handling times.
  uint64_t longest_us = 0; ///< Longest handling time.

  static constexpr auto fields() {
    return field_list{required("name", &actor_row::name),
                      required("id", &actor_row::id),
                      optional("parent", &actor_row::parent),
                      required("messages", &actor_row::messages),
                      required("mailbox", &actor_row::mailbox),
                      required("busy_us", &actor_row::busy_us),
                      required("longest_us", &actor_row::longest_us)};
  }
};

struct node_query {
  static constexpr const char* type = "node_query";
  bool actors = false; ///< Also list the node's actors with their counters.
  std::string node;    ///< Which one; empty: the one that is asked.

  static constexpr auto fields() {
    return field_list{optional("actors", &node_query::actors),
                      optional("node", &node_query::node)};
  }
};

/// An attempt to come into a cell that has not succeeded yet.
struct join_failure {
  /// The discovery server that is tried, as "host:port"; empty: any cell that
  /// is visible will do.
  std::string address;
  std::string problem;  ///< What is wrong there; empty: nothing is known yet.
  std::string hint;     ///< What to do about it; may be empty.
  int64_t attempts = 0; ///< Since the node was in a cell, or was started.
  int64_t tried_unix_ms = 0; ///< When the last one began.

  static constexpr auto fields() {
    return field_list{optional("address", &join_failure::address),
                      optional("trouble", &join_failure::problem),
                      optional("hint", &join_failure::hint),
                      required("attempts", &join_failure::attempts),
                      required("tried_unix_ms", &join_failure::tried_unix_ms)};
  }
};

struct node_description {
  static constexpr const char* type = "node_description";
  node_identity identity;
  node_role role = node_role::primary;
  node_state state = node_state::independent;
  std::string version;     ///< Of this program.
  std::string cell;        ///< Empty: in none.
  std::string coordinator; ///< Address of the coordinator's HTTP port.
  std::string runtime;     ///< "process", "docker" or "podman".
  int64_t started_unix_ms = 0;
  node_resources resources;
  std::vector<installed_skill> skills;
  std::vector<instance_row> instances;
  std::vector<actor_row> actors;
  int64_t stored_bytes = 0; ///< Written to the database since the start.
  std::vector<skill_problem> refused_skills; ///< The first of them.
  std::vector<join_failure> joining; ///< At most one; empty: it does not try.
  /// What a ROS 2 program on this node needs to be in its cell; empty: it is in
  /// none.
  std::map<std::string, std::string> environment;
  std::string
      limits; ///< What holds its instances to their limits, or why none.

  static constexpr auto fields() {
    return field_list{
        required("identity", &node_description::identity),
        required("role", &node_description::role),
        required("state", &node_description::state),
        required("version", &node_description::version),
        optional("cell", &node_description::cell),
        optional("coordinator", &node_description::coordinator),
        required("runtime", &node_description::runtime),
        required("started_unix_ms", &node_description::started_unix_ms),
        required("resources", &node_description::resources),
        required("skills", &node_description::skills),
        required("instances", &node_description::instances),
        optional("actors", &node_description::actors),
        optional("stored_bytes", &node_description::stored_bytes),
        optional("refused_skills", &node_description::refused_skills),
        optional("joining", &node_description::joining),
        optional("environment", &node_description::environment),
        optional("limits", &node_description::limits)};
  }
};

/// Asks a node what anybody may know of it.
struct hello_query {
  static constexpr const char* type = "hello_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

/// What a node says of itself to unauthenticated peers: who wants to join a
/// cell and was given a wrong address learns from it which one is right.
struct node_hello {
  static constexpr const char* type = "node_hello";
  std::string node; ///< Its name.
  node_role role = node_role::primary;
  node_state state = node_state::independent;
  std::string version;          ///< Of its program.
  std::string cell;             ///< Empty: in none.
  std::string coordinator;      ///< Address of the coordinator's HTTP port.
  std::string discovery_server; ///< Of its cell, as "host:port".
  int64_t domain_id = 0;        ///< The ROS domain of the cell's skills.
  int64_t public_domain = 0;    ///< In which coordinators see each other.

  static constexpr auto fields() {
    return field_list{
        required("node", &node_hello::node),
        required("role", &node_hello::role),
        required("state", &node_hello::state),
        required("version", &node_hello::version),
        optional("cell", &node_hello::cell),
        optional("coordinator", &node_hello::coordinator),
        optional("discovery_server", &node_hello::discovery_server),
        required("domain_id", &node_hello::domain_id),
        required("public_domain", &node_hello::public_domain)};
  }
};

} // namespace roscell
