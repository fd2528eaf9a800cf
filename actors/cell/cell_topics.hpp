#pragma once

#include "actors/edge/dds/ros_graph.hpp"
#include "messages/instance.hpp"
#include "messages/topic.hpp"

#include <string>
#include <vector>

namespace roscell {

/// The topics that somebody writes, an entry a writer.
std::vector<io_endpoint> written_topics(ros_graph& graph);

/// The topics in these ends, by name and type; of `topic` alone unless it is
/// empty. Tells of pairs that will never match: by DDS 1.4, 2.2.3, a reader may
/// want no more of reliability and durability than its writer offers.
std::vector<topic_row> topic_rows(const std::vector<graph_endpoint>& ends,
                                  const std::string& topic);

} // namespace roscell
