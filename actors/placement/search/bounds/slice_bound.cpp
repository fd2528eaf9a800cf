#include "actors/placement/search/bounds/slice_bound.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

double distance(double x, double low, double high) {
  return x < low ? low - x : std::max(0.0, x - high);
}

/// Per kind, how many nodes more than there are the groups want.
std::vector<double> excess(const group_list& groups,
                           const std::vector<std::uint32_t>& chosen) {
  std::vector<double> more;
  for (const auto& nodes : groups.kinds)
    more.push_back(-static_cast<double>(nodes.size()));
  for (auto g : chosen)
    ++more[groups.of[g].kind];
  return more;
}

/// Keeps the prices moving where the bound is as good as the best total.
constexpr double least_missing = 1e-9;

} // namespace

slice_bound::slice_bound(const search_space& space, const group_list& groups)
    : space_(space), groups_(groups), all_((step_set{1} << space.steps()) - 1),
      cover_(space.steps()), weights_(groups.of.size()),
      lightest_(std::size_t{1} << space.steps()) {
  // nop
}

double slice_bound::weigh(const slice& one, const std::vector<double>& prices) {
  rebate_ = 0;
  for (std::size_t k = 0; k < prices.size(); ++k)
    rebate_ += prices[k] * static_cast<double>(groups_.kinds[k].size());
  cover_.begin(one.count);
  for (auto g : one.groups) {
    const auto& of = groups_.of[g];
    weights_[g] = of.cost / static_cast<double>(space_.steps())
                  + load_term(one, of) + prices[of.kind];
    if (cover_.offer(of.steps, weights_[g]))
      lightest_[of.steps] = g;
  }
  cover_.finish();
  return cover_.least(one.count, all_) - rebate_;
}

/// What the node adds to the load term at least, with the mean in the slice.
double slice_bound::load_term(const slice& one, const group& of) const {
  auto off = distance(of.load, one.low, one.high);
  return space_.asked.alpha * off * off / static_cast<double>(one.count);
}

std::vector<std::uint32_t> slice_bound::lightest(const slice& one) const {
  std::vector<std::uint32_t> chosen;
  for (auto set : cover_.cheapest(one.count, all_))
    chosen.push_back(lightest_[set]);
  return chosen;
}

void slice_bound::drop_useless(slice& one, double most_total) {
  cover_.finish_rest();
  const auto most = most_total + rebate_;
  auto is_useless = [&](std::uint32_t g) {
    auto rest = all_ ^ groups_.of[g].steps;
    return weights_[g] + cover_.least(one.count - 1, rest) > most;
  };
  one.groups.erase(
      std::remove_if(one.groups.begin(), one.groups.end(), is_useless),
      one.groups.end());
}

bool correct_prices(const group_list& groups,
                    const std::vector<std::uint32_t>& chosen, double missing,
                    std::vector<double>& prices) {
  const auto more = excess(groups, chosen);
  double length = 0;
  for (std::size_t k = 0; k < more.size(); ++k)
    if (more[k] > 0 || prices[k] > 0)
      length += more[k] * more[k];
  if (length == 0)
    return false;
  const auto pace = std::max(missing, least_missing) / length;
  for (std::size_t k = 0; k < more.size(); ++k)
    prices[k] = std::max(0.0, prices[k] + pace * more[k]);
  return true;
}

bool is_allocation(const group_list& groups,
                   const std::vector<std::uint32_t>& chosen) {
  const auto more = excess(groups, chosen);
  return std::all_of(more.begin(), more.end(),
                     [](double one) { return one <= 0; });
}

} // namespace roscell::allocation
