#include "actors/placement/search/bounds/lower_bound.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

/// A row holds the nodes for a step at one depth, one more than can host the
/// steps before it, but no more than this many: when all of these host steps,
/// the last one bounds those that were left out.
constexpr std::size_t row_length = 16;

/// The range of the fraction when up to `taken` of what is free may go to
/// steps that are still to be placed before this one.
interval fraction_range(const share& now, double taken) {
  if (now.request <= 0)
    return {0, 0};
  auto fraction = now.fraction();
  if (taken <= 0)
    return {fraction, fraction};
  // The request must still fit, and one that fits takes less than twice what
  // is free or, where nothing is free, counts as 1.
  auto least_free = std::max(now.free - taken, now.request - tolerance);
  return {std::min(fraction, 1.0),
          least_free > tolerance ? now.request / least_free : 2.0};
}

} // namespace

lower_bound::lower_bound(const problem& asked, const candidate_set& candidates,
                         const occupancy& empty, std::size_t row_work)
    : asked_(asked), candidates_(candidates), empty_(empty) {
  sum_up_most_taken();
  fill_rows(row_work);
}

void lower_bound::sum_up_most_taken() {
  taken_.emplace_back(asked_.nodes.size());
  for (std::size_t i = 0; i < asked_.steps.size(); ++i) {
    std::vector<amounts> most(asked_.nodes.size());
    for (const auto& choice : candidates_.of[i]) {
      const auto& way = asked_.steps[i].deployments[choice.deployment];
      amounts takes{way.cpu, way.memory_mib, way.disk_mib, way.gpu_memory_mib};
      if (asked_.nodes[choice.node].unified_memory) {
        takes[memory] += way.gpu_memory_mib;
        takes[gpu_memory] = takes[memory];
      }
      for (std::size_t r = 0; r < resource_count; ++r)
        most[choice.node][r] = std::max(most[choice.node][r], takes[r]);
    }
    for (std::size_t v = 0; v < most.size(); ++v)
      for (std::size_t r = 0; r < resource_count; ++r)
        most[v][r] += taken_.back()[v][r];
    taken_.push_back(std::move(most));
  }
}

void lower_bound::fill_rows(std::size_t row_work) {
  auto steps = asked_.steps.size();
  std::size_t work = 1;
  for (const auto& list : candidates_.of)
    work += list.size();
  auto rows = std::clamp<std::size_t>(row_work / work, 1, steps);
  stride_ = (steps + rows - 1) / rows;
  for (std::size_t depth = 0; depth < steps; depth += stride_) {
    rows_.emplace_back(steps);
    for (std::size_t i = depth; i < steps; ++i)
      rows_.back()[i] = cheapest_nodes(depth, i);
  }
}

std::vector<lower_bound::choice_cost>
lower_bound::cheapest_nodes(std::size_t depth, std::size_t step) {
  std::vector<choice_cost> costs;
  for (std::uint32_t v = 0; v < asked_.nodes.size(); ++v) {
    auto least = cost_on(empty_, depth, step, v);
    if (least < infinity)
      costs.push_back({least, v});
  }
  auto kept = std::min({costs.size(), row_length, step + 1});
  std::partial_sort(costs.begin(), costs.begin() + static_cast<long>(kept),
                    costs.end(), [](const auto& left, const auto& right) {
                      return left.cost < right.cost;
                    });
  costs.resize(kept);
  return costs;
}

double lower_bound::cost(const occupancy& now, std::size_t depth,
                         std::size_t step, const candidate& choice) const {
  const auto& way = asked_.steps[step].deployments[choice.deployment];
  auto all = now.shares_of(way, choice);
  if (!all.fit())
    return infinity;
  std::array<interval, resource_count> ranges;
  for (std::size_t r = 0; r < all.count; ++r)
    ranges[r] =
        fraction_range(all.of[r], most_taken(choice.node, depth, step, r));
  return least_spread(ranges.data(), all.count) / static_cast<double>(all.count)
         + (way.needs_gpu ? asked_.gpu_bonus : 0);
}

double lower_bound::cost_on(const occupancy& now, std::size_t depth,
                            std::size_t step, std::size_t node) const {
  const auto& from = candidates_.from[step];
  double least = infinity;
  for (auto c = from[node]; c < from[node + 1]; ++c)
    least = std::min(least, cost(now, depth, step, candidates_.of[step][c]));
  return least;
}

double lower_bound::step_cost(const occupancy& now, std::size_t depth,
                              std::size_t step) const {
  const auto& row = rows_[depth / stride_][step];
  auto idle = std::find_if(row.begin(), row.end(), [&](const auto& entry) {
    return !now.hosts(entry.node);
  });
  double least = infinity;
  if (idle != row.end())
    least = idle->cost;
  else if (row.size() == row_length)
    least = row.back().cost;
  for (auto node : now.used_nodes())
    least = std::min(least, cost_on(now, depth, step, node));
  return least;
}

double lower_bound::balance(const occupancy& now, std::size_t depth,
                            std::size_t first) const {
  double sum = 0;
  for (auto i = first; i < asked_.steps.size() && sum < infinity; ++i)
    sum += step_cost(now, depth, i);
  return sum;
}

double lower_bound::load(const occupancy& now, std::size_t depth) const {
  auto steps = asked_.steps.size();
  std::vector<interval> loads;
  for (auto node : now.used_nodes()) {
    auto rise = now.load_rise(node, most_taken(node, depth, steps, cpu),
                              most_taken(node, depth, steps, memory));
    loads.push_back({now.load(node), now.load(node) + rise});
  }
  auto most_nodes = loads.size() + steps - depth;
  return least_spread(loads.data(), loads.size())
         / static_cast<double>(most_nodes);
}

namespace {

/// How far t lies above the interval, negative below it, 0 within it.
double beyond(const interval& one, double t) {
  return t > one.high ? t - one.high : std::min(t - one.low, 0.0);
}

/// Half of the derivative of the sum of squared distances, rising in t.
double slope(const interval* of, std::size_t count, double t) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += beyond(of[i], t);
  return sum;
}

} // namespace

double least_spread(const interval* of, std::size_t count) {
  if (count < 2)
    return 0;
  double lowest_high = of[0].high;
  double highest_low = of[0].low;
  for (std::size_t i = 1; i < count; ++i) {
    lowest_high = std::min(lowest_high, of[i].high);
    highest_low = std::max(highest_low, of[i].low);
  }
  if (highest_low <= lowest_high)
    return 0;
  // The slope is not positive at the lowest end. The last breakpoint where
  // that still holds starts the piece which holds the minimum.
  double start = lowest_high;
  double start_slope = slope(of, count, start);
  for (std::size_t i = 0; i < count; ++i)
    for (double end : {of[i].low, of[i].high}) {
      if (end <= start)
        continue;
      double here = slope(of, count, end);
      if (here <= 0) {
        start = end;
        start_slope = here;
      }
    }
  double outside = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (of[i].high <= start || of[i].low > start)
      ++outside;
  double t = outside > 0 ? start - start_slope / outside : start;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += beyond(of[i], t) * beyond(of[i], t);
  return sum;
}

} // namespace roscell::allocation
