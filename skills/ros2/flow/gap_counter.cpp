#include "skills/ros2/flow/gap_counter.hpp"

#include <algorithm>
#include <utility>

namespace roscell::ros2 {

namespace {

/// Writers come and go for as long as a skill runs.
constexpr std::size_t max_writers = 1024;

} // namespace

std::uint64_t gap_counter::add(const guid& writer, std::uint64_t number) {
  auto known = last_.find(writer);
  if (known == last_.end()) {
    if (last_.size() >= max_writers)
      last_.clear();
    last_.emplace(writer, number);
    return 0;
  }
  auto last = std::exchange(known->second, std::max(known->second, number));
  return number > last ? number - last - 1 : 0;
}

std::uint64_t gap_counter::last(const guid& writer) const {
  const auto known = last_.find(writer);
  return known == last_.end() ? 0 : known->second;
}

} // namespace roscell::ros2
