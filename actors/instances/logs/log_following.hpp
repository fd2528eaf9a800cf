#pragma once

#include "actors/core/alarm.hpp"
#include "messages/instance.hpp"

#include <caf/error.hpp>
#include <caf/typed_response_promise.hpp>

#include <chrono>

/// What every runtime does alike for those who read its instances' logs.
namespace roscell {

/// Someone who waits for more of a log.
struct log_follower {
  log_query query;
  alarm::time_point until;
  caf::typed_response_promise<log_excerpt> promise;
};

/// How long `query` may be kept waiting; zero: not at all.
std::chrono::milliseconds wait_of(const log_query& query);

/// Whether an excerpt is worth an answer before its time is over.
bool says_something(const log_excerpt& x);

/// unknown_task.
caf::error no_log_of(const std::string& instance);

/// conflict: an answer without a word would be asked again at once.
caf::error too_many_followers();

} // namespace roscell
