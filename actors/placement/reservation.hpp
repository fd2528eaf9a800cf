#pragma once

#include "messages/resources.hpp"

#include <string>
#include <vector>

namespace roscell {

/// The cores that others would share with a new process: a host whose cores
/// are busy still gives it `floor` of what the node offers. `of_others` counts
/// none of our instances; a floor of 0 counts on nothing.
double compressible_cpu(const amount& of_others, double floor);

/// Takes off what is compressible, as a floored reading does.
void read_with_cpu_floor(node_resources& node);

/// Adds an instance's reservation to what is in use on its node: GPU memory on
/// the GPU of that index, or in the node's pool where memory is unified.
void reserve(node_resources& node, const resource_request& request, int gpu);

/// Takes it off again.
void unreserve(node_resources& node, const resource_request& request, int gpu);

/// What a node is short of for an instance, a sentence each; empty if it fits.
std::vector<std::string> shortages(const node_resources& node,
                                   const resource_request& request, int gpu);

} // namespace roscell
