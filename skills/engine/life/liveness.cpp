#include "skills/engine/life/liveness.hpp"

#include <utility>

namespace roscell::engine {

void liveness::work_begins(clock::time_point now) {
  std::lock_guard guard{mutex_};
  busy_since_ = now;
}

bool liveness::work_ends() {
  std::lock_guard guard{mutex_};
  busy_since_.reset();
  return std::exchange(withheld_, false);
}

bool liveness::allows_heartbeat(clock::time_point now) {
  std::lock_guard guard{mutex_};
  withheld_ = busy_since_ && now - *busy_since_ >= period_ / 2;
  return !withheld_;
}

} // namespace roscell::engine
