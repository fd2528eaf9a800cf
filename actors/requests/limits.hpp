#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Requests from outside.
namespace roscell::limits {

namespace resource {

/// What a scraper of metrics waits for those of the members: those that come
/// later are in its next scrape.
constexpr milliseconds scrape_collection{5};

} // namespace resource

namespace task {

/// How often a task is placed anew because nodes refused or left.
constexpr int placement_rounds = 3;
/// To end instances of a task and to start them again.
constexpr seconds restart{870};
/// For other parameters of an instance: its node has `session::parameters`.
constexpr seconds parameters{15};
/// How many wait at a time for a change of a task: half of the clients that an
/// HTTP server works for at once.
constexpr size_t change_waiters = 32;

/// For the others of a deployment that failed to be removed.
constexpr seconds rollback{60};

/// For the placement lock, or for the first reply to the same request: whoever
/// asks gives up before that.
constexpr minutes claim{16};

} // namespace task

namespace request {

/// Answers that are remembered for the case that a request comes again, and
/// the memory that they may take with their requests.
constexpr size_t remembered = 256;
constexpr size_t remembered_bytes = 4 * mib;

} // namespace request

} // namespace roscell::limits
