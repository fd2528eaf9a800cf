#pragma once

#include "messages/cell.hpp"
#include "messages/instance.hpp"
#include "messages/node.hpp"
#include "messages/topic.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/checks.hpp"

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

} // namespace roscell::cli
