#pragma once

#include "messages/event.hpp"
#include "messages/node.hpp"
#include "tools/roscell/view/describe/page.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <vector>

/// INTERNAL to descriptions: tables and words that several of them have.
namespace roscell::cli {

table resources_table(const node_resources& r);
table events_table(const std::vector<event>& events, const view_style& style);
table instances_table(const std::vector<instance_row>& rows,
                      const view_style& style);

/// A row for each stream: whether it goes in or out, where, and what it does.
table ports_table(const instance_row& row);

/// A row for each parameter of an instance.
table parameters_table(const std::string& parameters);

/// "running, since 5m03s (2026-11-22 17:01:02)", or "unknown, ...".
std::string instance_state_text(const instance_row& row,
                                const view_style& style);

/// "5m03s ago (2026-11-22 17:01:02.345)"; empty for a time that is not known.
std::string time_and_age_text(int64_t unix_ms, const view_style& style);

/// "cpu 1, memory 96 MiB, disk 150 MiB"
std::string resource_request_text(const resource_request& r);

} // namespace roscell::cli
