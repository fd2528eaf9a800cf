#pragma once

#include "actors/edge/dds/ros_graph.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/requests/metrics/exposition.hpp"
#include "actors/requests/request_context.hpp"
#include "messages/inside/coordination.hpp"

#include <memory>

namespace roscell {

/// Answers `GET /metrics`: asks the node or, on a coordinator, the cell for
/// what they know, and writes it down with what was counted. What does not
/// answer in time is left out, or as it was told before. The actor ends with
/// the answer.
void start_scrape(caf::actor_system& system,
                  const std::shared_ptr<const node_services>& services,
                  const responder& answer, exposition_format format);

// What is known of a node and its cell, as metrics. Names and units as
// https://prometheus.io/docs/practices/naming has them.

/// Of this node's own process.
/// @param booted_unix_s when the host was booted, by its clock of now.
void write_cost(const own_cost& cost, double booted_unix_s, exposition& to);

/// Of this node's discovery server.
void write_participants(const participant_counts& known, exposition& to);

/// Of all nodes of a cell: what they have, how they stand, and the tasks.
void write_cell(const cell_measured& cell, exposition& to);

/// Of a node without a cell of its own.
void write_node(const node_resources& node, exposition& to);

void write_instances(const std::vector<instance_measures>& instances,
                     exposition& to);

} // namespace roscell
