#pragma once

#include "actors/instances/skills/skill_catalogue.hpp"

#include <memory>
#include <mutex>
#include <utility>

namespace roscell {

/// The skills of a node at present, for all threads that want them. Who holds a
/// catalogue or a folder of it has it as it was.
class current_skills {
public:
  explicit current_skills(shared_skill_catalogue first)
      : now_{std::move(first)} {}

  shared_skill_catalogue get() const {
    const std::lock_guard guard{mutex_};
    return now_;
  }

  void set(shared_skill_catalogue next) {
    const std::lock_guard guard{mutex_};
    now_ = std::move(next);
  }

private:
  mutable std::mutex mutex_;
  shared_skill_catalogue now_;
};

using shared_skills = std::shared_ptr<current_skills>;

} // namespace roscell
