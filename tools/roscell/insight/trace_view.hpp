#pragma once

#include "messages/insight/request_trace.hpp"
#include "tools/roscell/view/table.hpp"

#include <string>

namespace roscell::cli {

/// A microsecond and up, with the unit that people read: "840 us", "12.3 ms",
/// "2.5 s". "-" for a span that has no end yet.
std::string span_text(int64_t us);

/// The way of one request: a line about it, and a row per hop and per actor
/// that a hop has asked.
std::string trace_view(const request_trace& trace, const text_style& style);

} // namespace roscell::cli
