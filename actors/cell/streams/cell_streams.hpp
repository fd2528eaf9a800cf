#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <set>
#include <string>

/// What the CELL COORDINATOR makes of the metrics that nodes tell: an instance
/// that gets nothing although its writer sends is starved, whether its step
/// asks for bounds or not. It is judged whenever somebody has had the nodes
/// asked, and when a node has told that an input is silent. See `stream_watch`.
namespace roscell {

/// These nodes have just told what their skills say. What has changed is told
/// as an event.
void judge_streams(coordinator_pointer self,
                   const std::set<std::string>& reported);

/// Whether what a node has told unasked of an instance may change its
/// judgement.
bool is_doubtful(const cell_coordinator_state& st, const instance_row& row);

/// The health of an instance by its node's word, and by its streams.
void add_verdict(const cell_coordinator_state& st, instance_row& row);
instance_health health_of(const cell_coordinator_state& st,
                          const std::string& instance, instance_state state,
                          instance_health reported);

/// Tells how an instance on a node stands, to whoever listens and in the
/// history of its task.
void publish_change(coordinator_pointer self, instance_row x,
                    const std::string& node);

} // namespace roscell
