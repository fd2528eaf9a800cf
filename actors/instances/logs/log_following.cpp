#include "actors/instances/logs/log_following.hpp"

#include "actors/core/answer_limits.hpp"
#include "messages/failure.hpp"

#include <algorithm>

namespace roscell {

std::chrono::milliseconds wait_of(const log_query& query) {
  return std::chrono::milliseconds{
      std::clamp<int64_t>(query.wait_ms, 0, limits::log::wait.count())};
}

bool says_something(const log_excerpt& x) {
  return !x.text.empty() || x.ended;
}

caf::error no_log_of(const std::string& instance) {
  return fail(error_code::unknown_task,
              "there is no log of an instance '" + instance + "'", "/instance",
              "`roscell instances` lists them");
}

caf::error too_many_followers() {
  return fail(error_code::conflict, "too many follow the logs of this node", {},
              "ask without following");
}

} // namespace roscell
