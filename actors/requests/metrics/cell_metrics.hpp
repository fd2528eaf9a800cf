#pragma once

#include "actors/edge/dds/ros_graph.hpp"
#include "actors/edge/host/own_cost.hpp"
#include "actors/requests/metrics/exposition.hpp"
#include "messages/inside/measures.hpp"

/// What is known of a node and its cell, as metrics. Names and units as
/// https://prometheus.io/docs/practices/naming has them.
namespace roscell {

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
