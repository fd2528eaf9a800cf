#include "actors/cell/updates/update_order.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "messages/stream_protocols.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace roscell {

namespace {

bool is_same_topic(const io_endpoint& x, const io_endpoint& y) {
  return x.protocol == protocols::ros2 && y.protocol == protocols::ros2
         && full_topic(x.endpoint) == full_topic(y.endpoint);
}

/// Files are those of one node.
bool is_same_file(const io_endpoint& x, const io_endpoint& y) {
  return x.protocol != protocols::ros2 && y.protocol != protocols::ros2
         && overlap(x.endpoint, y.endpoint);
}

template <class Predicate>
bool any_pair(const std::vector<io_endpoint>& xs,
              const std::vector<io_endpoint>& ys, Predicate&& is_it) {
  return std::any_of(xs.begin(), xs.end(), [&](const auto& x) {
    return std::any_of(ys.begin(), ys.end(),
                       [&](const auto& y) { return is_it(x, y); });
  });
}

/// Only one can have a camera open.
bool is_same_device(const io_endpoint& x, const io_endpoint& y) {
  return is_device(x.endpoint) && x.endpoint == y.endpoint;
}

/// Whether the old one of `y` has to end before the new one of `x` starts.
bool waits_for(const replaced_step& x, const replaced_step& y) {
  if (!x.fresh || !y.old)
    return false;
  if (any_pair(x.fresh->output, y.old->output, is_same_topic))
    return true;
  if (x.fresh_node != y.old_node)
    return false;
  return x.needs_room || any_pair(x.fresh->output, y.old->output, is_same_file)
         || any_pair(x.fresh->input, y.old->input, is_same_device);
}

/// The first step of each one's wave.
class wave_roots {
public:
  explicit wave_roots(size_t steps) : parents_(steps) {
    std::iota(parents_.begin(), parents_.end(), size_t{0});
  }

  size_t of(size_t step) const {
    while (parents_[step] != step)
      step = parents_[step];
    return step;
  }

  void join(size_t x, size_t y) {
    x = of(x);
    y = of(y);
    parents_[std::max(x, y)] = std::min(x, y);
  }

private:
  std::vector<size_t> parents_;
};

} // namespace

std::vector<std::vector<size_t>>
update_waves(const std::vector<replaced_step>& steps) {
  wave_roots roots{steps.size()};
  for (size_t i = 0; i < steps.size(); ++i)
    for (size_t k = 0; k < steps.size(); ++k)
      if (i != k && waits_for(steps[i], steps[k]))
        roots.join(i, k);
  struct wave {
    size_t rank = 0;
    std::vector<size_t> steps;
  };
  std::map<size_t, wave> by_root;
  for (size_t i = 0; i < steps.size(); ++i) {
    auto& x = by_root[roots.of(i)];
    const auto rank = steps[i].fresh ? steps[i].rank : steps.size();
    x.rank = x.steps.empty() ? rank : std::min(x.rank, rank);
    x.steps.push_back(i);
  }
  std::vector<wave> waves;
  waves.reserve(by_root.size());
  for (auto& [root, x] : by_root)
    waves.push_back(std::move(x));
  std::stable_sort(
      waves.begin(), waves.end(),
      [](const auto& x, const auto& y) { return x.rank < y.rank; });
  std::vector<std::vector<size_t>> result;
  result.reserve(waves.size());
  for (auto& x : waves)
    result.push_back(std::move(x.steps));
  return result;
}

} // namespace roscell
