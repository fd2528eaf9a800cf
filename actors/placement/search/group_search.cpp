#include "actors/placement/search/group_search.hpp"

#include "actors/placement/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace roscell::allocation {

namespace {

/// Groups looked at before a slice is split rather than searched on.
constexpr std::size_t effort_per_slice = 20'000;

/// Prices are corrected so many times more in each half of a slice, since what
/// a search of the whole has not settled needs better ones.
constexpr int more_rounds = 5;

/// Corrections become smaller when one has not helped.
constexpr double shrinking = 0.7;

/// Loads this close need no further split.
constexpr double narrow = 1e-6;

bool comes_later(const slice& left, const slice& right) {
  return left.bound > right.bound;
}

void split(const slice& one, std::vector<slice>& into) {
  auto middle = (one.low + one.high) / 2;
  for (auto half : {std::pair(one.low, middle), std::pair(middle, one.high)}) {
    into.push_back(one);
    into.back().tight = false;
    into.back().rounds += more_rounds;
    into.back().low = half.first;
    into.back().high = half.second;
    std::push_heap(into.begin(), into.end(), comes_later);
  }
}

/// One slice per number of nodes.
std::vector<slice> all_slices(const search_space& space,
                              const group_list& groups, double least) {
  slice all;
  all.prices.resize(groups.kinds.size());
  all.low = infinity;
  all.bound = least;
  for (std::uint32_t g = 0; g < groups.of.size(); ++g) {
    all.groups.push_back(g);
    all.low = std::min(all.low, groups.of[g].load);
    all.high = std::max(all.high, groups.of[g].load);
  }
  std::vector<slice> slices;
  auto most = std::min(space.steps(), space.asked.nodes.size());
  for (all.count = 1; all.count <= most; ++all.count)
    slices.push_back(all);
  return slices;
}

} // namespace

group_search::group_search(const search_space& space, const group_list& groups,
                           const assignment& start, double least, watch& until)
    : space_(space), groups_(groups), until_(until), bound_(space, groups),
      starting_at_(space.steps()), used_(groups.kinds.size()),
      current_(space.steps()), best_(start), least_(least) {
  auto scratch = space.empty;
  auto value = evaluate(space, start, scratch);
  best_total_ = value.value_or(score{infinity, 0, 0}).total;
  proven_ = best_total_;
  scale_ = 1 + space.asked.alpha + std::abs(space.asked.gpu_bonus);
}

void group_search::minimise() {
  settling_ = false;
  proven_ = infinity;
  work_off(all_slices(space_, groups_, least_));
  proven_ = std::min(proven_, best_total_);
}

void group_search::settle_tie() {
  settling_ = true;
  auto minimal = best_;
  work_off(std::exchange(done_, {}));
  if (until_.stopped())
    best_ = minimal;
}

/// The slice with the least bound first.
void group_search::work_off(std::vector<slice> slices) {
  std::make_heap(slices.begin(), slices.end(), comes_later);
  while (!slices.empty()) {
    std::pop_heap(slices.begin(), slices.end(), comes_later);
    auto one = std::move(slices.back());
    slices.pop_back();
    if (until_.stopped()) {
      leave(one);
      continue;
    }
    tighten(one);
    if (one.bound > loosest())
      continue;
    if (!slices.empty() && one.bound > slices.front().bound) {
      slices.push_back(std::move(one));
      std::push_heap(slices.begin(), slices.end(), comes_later);
    } else if (!work_on(one)) {
      split(one, slices);
    }
  }
}

/// A stop keeps the search from looking at all of the slice.
void group_search::leave(const slice& one) {
  if (!settling_)
    proven_ = std::min(proven_, one.bound);
}

/// False when it took too long and the slice is to be split.
bool group_search::work_on(slice& one) {
  if (!prunes(one.bound)) {
    sort_groups(one);
    effort_ = 0;
    most_effort_ = one.high - one.low > narrow
                       ? effort_per_slice
                       : std::numeric_limits<std::size_t>::max();
    dive((step_set{1} << space_.steps()) - 1, one.count, -bound_.rebate());
    if (until_.stopped())
      leave(one);
    else if (effort_ >= most_effort_)
      return false;
  }
  if (!settling_)
    done_.push_back(std::move(one));
  return true;
}

/// Finds good prices once, and drops the groups that the best total since then
/// has made useless. Leaves the slice weighed.
void group_search::tighten(slice& one) {
  auto prices = one.prices;
  auto share = 1.0;
  const auto rounds = std::exchange(one.tight, true) ? 0 : one.rounds;
  for (int i = 0; i < rounds && !until_.must_stop(); ++i) {
    auto bound = bound_.weigh(one, prices);
    if (bound > one.bound)
      one.prices = prices;
    else
      share *= shrinking;
    one.bound = std::max(one.bound, bound);
    if (one.bound > loosest())
      return;
    auto lightest = bound_.lightest(one);
    take(lightest);
    if (!correct_prices(groups_, lightest, share * (best_total_ - bound),
                        prices))
      break;
  }
  one.bound = std::max(one.bound, bound_.weigh(one, one.prices));
  bound_.drop_useless(one, loosest());
}

/// Groups that want no node twice are an allocation.
void group_search::take(const std::vector<std::uint32_t>& groups) {
  if (settling_ || !is_allocation(groups_, groups))
    return;
  for (auto g : groups)
    push(g);
  reach_end();
  while (!chosen_.empty())
    pop();
}

/// The lightest first; while settling, in the order of the tie rule as far as
/// one group tells.
void group_search::sort_groups(const slice& one) {
  for (auto& list : starting_at_)
    list.clear();
  for (auto g : one.groups)
    starting_at_[first_of(groups_.of[g].steps)].push_back(g);
  for (auto& list : starting_at_)
    std::sort(list.begin(), list.end(), [this](auto left, auto right) {
      if (!settling_)
        return std::pair(bound_.weight(left), left)
               < std::pair(bound_.weight(right), right);
      auto place = [this](std::uint32_t g) {
        return groups_.kinds[groups_.of[g].kind].front();
      };
      return std::pair(place(left), left) < std::pair(place(right), right);
    });
}

void group_search::dive(step_set open, std::size_t left, double sum) {
  if (open == 0) {
    reach_end();
    return;
  }
  for (auto g : starting_at_[first_of(open)]) {
    if (++effort_ >= most_effort_)
      return;
    if ((groups_.of[g].steps & ~open) == 0)
      try_group(g, open, left, sum);
  }
}

void group_search::try_group(std::uint32_t chosen, step_set open,
                             std::size_t left, double sum) {
  const auto& with = groups_.of[chosen];
  auto rest = open ^ with.steps;
  sum += bound_.weight(chosen);
  if (prunes(sum + bound_.least(left - 1, rest))
      || used_[with.kind] == groups_.kinds[with.kind].size()
      || until_.must_stop())
    return;
  push(chosen);
  if (!settling_ || !is_late(rest))
    dive(rest, left - 1, sum);
  pop();
}

/// Takes the first node of its kind that is idle: the groups come in the order
/// of their first steps, so this is what the tie rule asks for.
void group_search::push(std::uint32_t chosen) {
  const auto& with = groups_.of[chosen];
  auto node = groups_.kinds[with.kind][used_[with.kind]++];
  auto way = with.ways;
  for (auto open = with.steps; open != 0; open &= open - 1) {
    auto i = first_of(open);
    current_[i] = space_.candidates.from[i][node] + groups_.ways[way++];
  }
  chosen_.push_back(chosen);
}

void group_search::pop() {
  --used_[groups_.of[chosen_.back()].kind];
  chosen_.pop_back();
}

/// Whether what is placed before the first open step comes after the best
/// assignment in the order of the tie rule, or is all of it.
bool group_search::is_late(step_set open) const {
  auto known = open == 0 ? space_.steps() : first_of(open);
  for (std::size_t i = 0; i < known; ++i)
    if (current_[i] != best_[i])
      return current_[i] > best_[i];
  return open == 0;
}

void group_search::reach_end() {
  // What this leaves out is further above than rounding explains.
  auto most = settling_ ? best_total_ + tie_width : best_total_;
  if (quick_total() > most + tie_width * scale_)
    return;
  auto scratch = space_.empty;
  auto value = evaluate(space_, current_, scratch);
  if (!value)
    return;
  if (settling_ ? value->total <= most : value->total < most)
    best_ = current_;
  if (!settling_)
    best_total_ = std::min(best_total_, value->total);
}

double group_search::quick_total() const {
  double cost = 0;
  double mean = 0;
  auto count = static_cast<double>(chosen_.size());
  for (auto g : chosen_) {
    cost += groups_.of[g].cost;
    mean += groups_.of[g].load / count;
  }
  double sum = 0;
  for (auto g : chosen_)
    sum += (groups_.of[g].load - mean) * (groups_.of[g].load - mean);
  return cost / static_cast<double>(space_.steps())
         + space_.asked.alpha * sum / count;
}

/// Rounding must neither hide a tie while settling, nor make every tie look
/// better before.
bool group_search::prunes(double bound) const {
  return settling_ ? bound > loosest()
                   : bound >= best_total_ - tie_width * scale_ / 100;
}

/// Whatever is above this is no tie of the best.
double group_search::loosest() const {
  return best_total_ + tie_width * (1 + scale_);
}

} // namespace roscell::allocation
