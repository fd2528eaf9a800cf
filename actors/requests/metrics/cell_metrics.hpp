#pragma once

#include "actors/edge/host/own_cost.hpp"
#include "actors/requests/metrics/exposition.hpp"
#include "messages/cell.hpp"
#include "messages/node.hpp"

/// What is known of a node and its cell, as metrics. Names and units as
/// https://prometheus.io/docs/practices/naming has them.
namespace roscell {

void write_cost(const own_cost& cost, const node_description& node,
                exposition& to);

/// Of all nodes of a cell: what they have, how they stand, and the tasks.
void write_cell(const cell_description& cell, exposition& to);

/// Of a node without a cell of its own.
void write_node(const node_description& node, exposition& to);

void write_instances(const std::vector<instance_row>& instances,
                     exposition& to);

} // namespace roscell
