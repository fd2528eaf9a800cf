#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/insight/node_cost.hpp"
#include "messages/insight/request_trace.hpp"
#include "tools/roscell/view/table.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>

namespace roscell::cli {

/// What each node costs, a row for minute, hour and day; below them why there
/// are none of a node.
std::string cost_view(const cost_report& report, const view_style& style);

/// A JSON value for people: a line per member, what is within it indented,
/// short lists in one line.
std::string state_text(const json& value, size_t indent = 0);

/// A microsecond and up, with the unit that people read: "840 us", "12.3 ms",
/// "2.5 s". "-" for a span that has no end yet.
std::string span_text(int64_t us);

/// The way of one request: a line about it, and a row per hop and per actor
/// that a hop has asked.
std::string trace_view(const request_trace& trace, const text_style& style);

} // namespace roscell::cli
