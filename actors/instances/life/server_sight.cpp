#include "actors/instances/life/server_sight.hpp"

#include <utility>

namespace roscell {

void server_sight::hear(std::vector<std::string> missing, time_point now) {
  heard_ = true;
  missing_ = std::move(missing);
  if (missing_.empty())
    since_.reset();
  else if (!since_)
    since_ = now;
}

bool server_sight::judge(time_point now) {
  // Before the first word it is as it was, and while what is missing may yet
  // come, too.
  if (!heard_ || (since_ && now - *since_ < grace))
    return false;
  const bool did = std::exchange(misses_, since_.has_value());
  return misses_ != did;
}

std::string server_sight::reason() const {
  if (!misses_)
    return {};
  std::string result =
      "it is not known to its node's discovery server, which has not seen ";
  const char* before = "";
  for (const auto& x : missing_)
    result += std::exchange(before, ", ") + x;
  return result
         + ", so that nobody else hears of it; `roscell topics` and `roscell "
           "doctor` look for the cause";
}

} // namespace roscell
