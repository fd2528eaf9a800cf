#pragma once

#include "messages/codec/described.hpp"

#include <string>
#include <vector>

namespace roscell {

/// Asks what a node's own process costs its host, or that of each node.
struct cost_query {
  static constexpr const char* type = "cost_query";
  std::string node;  ///< Whose; empty: the one that is asked.
  bool cell = false; ///< Of each node of the cell.

  static constexpr auto fields() {
    return field_list{optional("node", &cost_query::node),
                      optional("cell", &cost_query::cell)};
  }
};

/// What went over the sessions with one other node.
struct peer_traffic {
  std::string peer;
  double sent_bytes = 0;
  double received_bytes = 0;

  static constexpr auto fields() {
    return field_list{
        required("peer", &peer_traffic::peer),
        required("sent_bytes", &peer_traffic::sent_bytes),
        required("received_bytes", &peer_traffic::received_bytes)};
  }
};

/// What a node has cost in some time that ends now.
struct cost_window {
  std::string window;       ///< "minute", "hour" or "day".
  double span_s = 0;        ///< What it really covers.
  double cpu_s = 0;         ///< Time of a core.
  double pss_bytes = 0;     ///< Mean of the memory.
  double written_bytes = 0; ///< To disks.
  std::vector<peer_traffic> peers;
  double builds_sent_bytes = 0;     ///< Of builds that other nodes fetched.
  double builds_received_bytes = 0; ///< Of builds that it fetched.

  static constexpr auto fields() {
    return field_list{
        required("window", &cost_window::window),
        required("span_s", &cost_window::span_s),
        required("cpu_s", &cost_window::cpu_s),
        required("pss_bytes", &cost_window::pss_bytes),
        required("written_bytes", &cost_window::written_bytes),
        required("peers", &cost_window::peers),
        optional("builds_sent_bytes", &cost_window::builds_sent_bytes),
        optional("builds_received_bytes", &cost_window::builds_received_bytes)};
  }
};

/// What one node costs.
struct node_cost {
  std::string node;
  std::vector<cost_window> windows; ///< Minute, hour, day.
  std::string problem;              ///< Why there are none; empty: there are.

  static constexpr auto fields() {
    return field_list{required("node", &node_cost::node),
                      required("windows", &node_cost::windows),
                      optional("trouble", &node_cost::problem)};
  }
};

/// Reply to `cost_query`.
struct cost_report {
  static constexpr const char* type = "cost_report";
  std::vector<node_cost> nodes;

  static constexpr auto fields() {
    return field_list{required("nodes", &cost_report::nodes)};
  }
};

} // namespace roscell
