#pragma once

#include "messages/cell.hpp"
#include "messages/instance.hpp"
#include "messages/node.hpp"
#include "messages/topic.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <memory>
#include <string>
#include <vector>

/// What a node tells of itself and its cell.
namespace roscell::cli {

/// It must be asked for; null: they can be listed only.
std::vector<check> node_checks(std::shared_ptr<const node_client> node);

/// @param version of this program.
findings judge_version(const node_description& node,
                       const std::string& version);
findings judge_joining(const node_description& node);
findings judge_refused_skills(const node_description& node);
findings judge_topics(const topic_list& topics);
findings judge_cell(const cell_description& cell);

// Whether instances do as they should, and take what they have asked for.

/// Nothing, if an instance takes no more of its host than it has asked for.
findings judge_use(const instance_row& row);

/// Whether anything holds the instances of a node to that.
findings judge_limits(const node_description& node);

/// What is wrong with each, or that nothing is.
findings judge_instances(const std::vector<instance_row>& rows);

} // namespace roscell::cli
