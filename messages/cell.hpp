#pragma once

#include "messages/codec/described.hpp"
#include "messages/node.hpp"
#include "messages/task.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// State of a node in a cell registry; only `active` rows are members.
enum class row_state { reserved, active, departing, lost, expected };

constexpr auto enum_words(row_state) {
  return std::array<std::string_view, 5>{"reserved", "active", "departing",
                                         "lost", "expected"};
}

/// One row of the cell registry.
struct registry_row {
  node_identity identity;
  node_role role = node_role::primary;
  row_state state = row_state::expected;
  int64_t since_unix_ms = 0; ///< When `state` was entered.
  std::string reason;        ///< Why the row is not active.
  node_resources resources;  ///< As last reported.
  std::vector<instance_row> instances;
  /// Since when it is to be empty and takes nothing new; 0: it is not.
  int64_t draining_since_unix_ms = 0;

  static constexpr auto fields() {
    return field_list{required("identity", &registry_row::identity),
                      required("role", &registry_row::role),
                      required("state", &registry_row::state),
                      required("since_unix_ms", &registry_row::since_unix_ms),
                      optional("reason", &registry_row::reason),
                      required("resources", &registry_row::resources),
                      required("instances", &registry_row::instances),
                      optional("draining_since_unix_ms",
                               &registry_row::draining_since_unix_ms)};
  }
};

/// A node that announces itself because it is in no cell.
struct unassigned_node {
  std::string name;
  std::string uuid;
  std::string address; ///< Of its HTTP port.
  node_state state = node_state::independent;
  std::string cell; ///< That it was in last.
  /// When it was missed, at most a lease after its last word; 0: it is there.
  int64_t silent_since_unix_ms = 0;

  static constexpr auto fields() {
    return field_list{required("name", &unassigned_node::name),
                      required("uuid", &unassigned_node::uuid),
                      required("address", &unassigned_node::address),
                      required("state", &unassigned_node::state),
                      optional("cell", &unassigned_node::cell),
                      optional("silent_since_unix_ms",
                               &unassigned_node::silent_since_unix_ms)};
  }
};

struct cell_query {
  static constexpr const char* type = "cell_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

struct cell_description {
  static constexpr const char* type = "cell_description";
  std::string cell;
  std::string coordinator;      ///< Name of the coordination node.
  std::string address;          ///< Its HTTP port.
  std::string discovery_server; ///< "ip:port", what `--join` takes.
  int64_t incarnation = 0;      ///< Raised at every start of the coordinator.
  std::vector<registry_row> nodes;
  std::vector<task_row> tasks;
  std::vector<unassigned_node> free; ///< Visible nodes that are in no cell.
  /// What a ROS 2 program in this cell needs of its environment.
  std::map<std::string, std::string> environment;

  static constexpr auto fields() {
    return field_list{
        required("cell", &cell_description::cell),
        required("coordinator", &cell_description::coordinator),
        required("address", &cell_description::address),
        required("discovery_server", &cell_description::discovery_server),
        required("incarnation", &cell_description::incarnation),
        required("nodes", &cell_description::nodes),
        required("tasks", &cell_description::tasks),
        optional("free", &cell_description::free),
        optional("environment", &cell_description::environment)};
  }
};

struct cell_list_query {
  static constexpr const char* type = "cell_list_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

/// One cell as its coordinator announces it.
struct cell_row {
  std::string cell;
  std::string coordinator;
  std::string address;
  std::string discovery_server;
  int64_t size = 0; ///< Active rows, the coordinator included.
  /// Why the coordinator that is asked does not know more of this cell.
  std::string problem;
  /// The cell's ROS_DISCOVERY_SERVER and ROS_DOMAIN_ID; empty: not known.
  std::map<std::string, std::string> environment;

  static constexpr auto fields() {
    return field_list{required("cell", &cell_row::cell),
                      required("coordinator", &cell_row::coordinator),
                      required("address", &cell_row::address),
                      required("discovery_server", &cell_row::discovery_server),
                      required("size", &cell_row::size),
                      optional("trouble", &cell_row::problem),
                      optional("environment", &cell_row::environment)};
  }
};

struct cell_list {
  static constexpr const char* type = "cell_list";
  std::vector<cell_row> cells;

  static constexpr auto fields() {
    return field_list{required("cells", &cell_list::cells)};
  }
};

/// As `cell_query`, after the nodes have been asked what they have and what is
/// in use: for somebody who looks. Reply: `cell_description`.
struct fresh_cell_query {
  static constexpr const char* type = "fresh_cell_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
