#pragma once

#include "messages/codec/described.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// How users form cells: bring nodes in, release them, move them.
namespace roscell {

/// What shall become of the instances on a node that leaves its cell.
enum class instance_policy {
  refuse,     ///< The node stays where it is; the error names them.
  terminate,  ///< The tasks that have a step on the node are terminated.
  reschedule, ///< They go to other members, or the node stays.
};

constexpr auto enum_words(instance_policy) {
  return std::array<std::string_view, 3>{"refuse", "terminate", "reschedule"};
}

/// Brings the named nodes into the cell of the coordinator that is asked.
struct cell_formation {
  static constexpr const char* type = "cell_formation";
  std::vector<std::string> members;
  instance_policy instances = instance_policy::refuse;

  static constexpr auto fields() {
    return field_list{required("members", &cell_formation::members),
                      optional("instances", &cell_formation::instances)};
  }
};

enum class formation_result { joined, already_member, failed };

constexpr auto enum_words(formation_result) {
  return std::array<std::string_view, 3>{"joined", "already_member", "failed"};
}

/// What became of one name.
struct formation_outcome {
  std::string node;
  formation_result result = formation_result::failed;
  std::string from;    ///< The cell that it came from; empty: none.
  std::string code;    ///< Why it failed, as in every error.
  std::string message; ///< The same for people.
  std::string hint;

  static constexpr auto fields() {
    return field_list{required("node", &formation_outcome::node),
                      required("result", &formation_outcome::result),
                      optional("from", &formation_outcome::from),
                      optional("code", &formation_outcome::code),
                      optional("message", &formation_outcome::message),
                      optional("hint", &formation_outcome::hint)};
  }
};

struct cell_formed {
  static constexpr const char* type = "cell_formed";
  std::string cell;
  std::vector<formation_outcome> outcomes; ///< In the order of the request.

  static constexpr auto fields() {
    return field_list{required("cell", &cell_formed::cell),
                      required("outcomes", &cell_formed::outcomes)};
  }
};

/// Makes a node independent.
struct node_release {
  static constexpr const char* type = "node_release";
  std::string node;
  instance_policy instances = instance_policy::refuse;
  bool forwarded = false; ///< By another coordinator; it goes no further.
  std::string cell;       ///< That the node is in; empty: not named.

  static constexpr auto fields() {
    return field_list{required("node", &node_release::node),
                      optional("instances", &node_release::instances),
                      optional("forwarded", &node_release::forwarded),
                      optional("cell", &node_release::cell)};
  }
};

struct node_released {
  static constexpr const char* type = "node_released";
  std::string node;
  std::string cell; ///< That it was in.
  std::string transfer;
  std::vector<std::string> terminated;  ///< Tasks.
  std::vector<std::string> rescheduled; ///< Tasks.

  static constexpr auto fields() {
    return field_list{required("node", &node_released::node),
                      required("cell", &node_released::cell),
                      required("transfer", &node_released::transfer),
                      optional("terminated", &node_released::terminated),
                      optional("rescheduled", &node_released::rescheduled)};
  }
};

/// Moves a node to another cell.
struct node_transfer {
  static constexpr const char* type = "node_transfer";
  std::string node;
  std::string target; ///< Name of the cell.
  instance_policy instances = instance_policy::refuse;
  bool forwarded = false; ///< By another coordinator; it goes no further.
  std::string cell;       ///< That the node is in; empty: not named.

  static constexpr auto fields() {
    return field_list{required("node", &node_transfer::node),
                      required("target", &node_transfer::target),
                      optional("instances", &node_transfer::instances),
                      optional("forwarded", &node_transfer::forwarded),
                      optional("cell", &node_transfer::cell)};
  }
};

struct node_transferred {
  static constexpr const char* type = "node_transferred";
  std::string node;
  std::string from;
  std::string to;
  std::string transfer;
  std::vector<std::string> terminated;  ///< Tasks.
  std::vector<std::string> rescheduled; ///< Tasks.

  static constexpr auto fields() {
    return field_list{required("node", &node_transferred::node),
                      required("from", &node_transferred::from),
                      required("to", &node_transferred::to),
                      required("transfer", &node_transferred::transfer),
                      optional("terminated", &node_transferred::terminated),
                      optional("rescheduled", &node_transferred::rescheduled)};
  }
};

/// Where a transfer or a release stands; the diagram is in docs/protocols.md.
enum class transfer_state {
  preparing, ///< The row is `departing`; instances go, a slot is reserved.
  switching, ///< The node has been told.
  done,
  returned,   ///< The node is back; nothing has changed.
  unresolved, ///< Not known yet; it resolves itself when the parties meet.
};

constexpr auto enum_words(transfer_state) {
  return std::array<std::string_view, 5>{"preparing", "switching", "done",
                                         "returned", "unresolved"};
}

struct transfer_row {
  std::string transfer;
  std::string node;
  std::string uuid; ///< Of the node.
  std::string from; ///< Cells.
  std::string to;   ///< Empty: independence.
  transfer_state state = transfer_state::preparing;
  std::string reason;
  int64_t since_unix_ms = 0; ///< When `state` was entered.

  static constexpr auto fields() {
    return field_list{required("transfer", &transfer_row::transfer),
                      required("node", &transfer_row::node),
                      required("uuid", &transfer_row::uuid),
                      required("from", &transfer_row::from),
                      optional("to", &transfer_row::to),
                      required("state", &transfer_row::state),
                      optional("reason", &transfer_row::reason),
                      required("since_unix_ms", &transfer_row::since_unix_ms)};
  }
};

struct transfer_query {
  static constexpr const char* type = "transfer_query";
  std::string transfer; ///< Empty: all that are remembered.

  static constexpr auto fields() {
    return field_list{optional("transfer", &transfer_query::transfer)};
  }
};

struct transfer_description {
  static constexpr const char* type = "transfer_description";
  std::vector<transfer_row> transfers;

  static constexpr auto fields() {
    return field_list{required("transfers", &transfer_description::transfers)};
  }
};

/// Moves every instance away from a node, which takes no new one from now on.
/// Answered at once; what still leaves is told by events.
struct node_drain {
  static constexpr const char* type = "node_drain";
  std::string node;
  bool force = false; ///< Nothing is waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("node", &node_drain::node),
                      optional("force", &node_drain::force)};
  }
};

/// Reply to `node_drain`: how far it is.
struct node_drained {
  static constexpr const char* type = "node_drained";
  std::string node;
  std::vector<std::string> left; ///< Instances that are still there.
  std::string problem; ///< Why they cannot go; empty: they are on their way.

  static constexpr auto fields() {
    return field_list{required("node", &node_drained::node),
                      required("left", &node_drained::left),
                      optional("trouble", &node_drained::problem)};
  }
};

/// Lets a node take instances again.
struct node_undrain {
  static constexpr const char* type = "node_undrain";
  std::string node;

  static constexpr auto fields() {
    return field_list{required("node", &node_undrain::node)};
  }
};

struct node_undrained {
  static constexpr const char* type = "node_undrained";
  std::string node;

  static constexpr auto fields() {
    return field_list{required("node", &node_undrained::node)};
  }
};

} // namespace roscell
