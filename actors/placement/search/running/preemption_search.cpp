#include "actors/placement/search/running/preemption_search.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace roscell::allocation {

namespace {

constexpr std::size_t first_gpu = gpu_memory;

} // namespace

// -- price ------------------------------------------------------------------

price& price::operator+=(const price& other) {
  count_ += other.count_;
  for (std::size_t i = 0; i < of_.size(); ++i)
    of_[i] += other.of_[i];
  return *this;
}

price& price::operator-=(const price& other) {
  count_ -= other.count_;
  for (std::size_t i = 0; i < of_.size(); ++i)
    of_[i] -= other.of_[i];
  return *this;
}

bool price::operator<(const price& other) const {
  if (count_ != other.count_)
    return count_ < other.count_;
  return std::lexicographical_compare(of_.rbegin(), of_.rend(),
                                      other.of_.rbegin(), other.of_.rend());
}

// -- the choice on one node -------------------------------------------------

/// Chooses offers that together give what is short: the fewest first.
class preemption_search::chooser {
public:
  chooser(const std::vector<offer>& offers, amounts shortage)
      : shortage_(std::move(shortage)) {
    for (const auto& x : offers)
      if (helps(x))
        offers_.push_back(&x);
    largest_.assign(offers_.size() + 1, amounts(shortage_.size(), 0));
    for (auto i = offers_.size(); i-- > 0;)
      for (std::size_t r = 0; r < shortage_.size(); ++r)
        largest_[i][r] =
            std::max(largest_[i + 1][r], std::max(0.0, offers_[i]->gives[r]));
  }

  std::optional<cover> run() {
    for (std::size_t count = 0; count <= offers_.size() && !best_; ++count)
      choose(0, count, price{}, shortage_);
    return std::move(best_);
  }

private:
  bool helps(const offer& x) const {
    for (std::size_t r = 0; r < shortage_.size(); ++r)
      if (shortage_[r] > tolerance && x.gives[r] > 0)
        return true;
    return false;
  }

  /// Whether `left` offers from `from` on could give so much.
  bool may_do(std::size_t from, std::size_t left, const amounts& lack) const {
    for (std::size_t r = 0; r < lack.size(); ++r)
      if (lack[r] > static_cast<double>(left) * largest_[from][r] + tolerance)
        return false;
    return true;
  }

  bool is_late(std::size_t from, std::size_t left, price cost) const {
    if (!best_)
      return false;
    // They are sorted by priority, so none that follows is lower.
    if (left > 0)
      cost.add(offers_[from]->priority, static_cast<int>(left));
    return !(cost < best_->cost);
  }

  void choose(std::size_t from, std::size_t left, price cost,
              const amounts& lack) {
    if (from + left > offers_.size() || !may_do(from, left, lack)
        || is_late(from, left, cost))
      return;
    if (left == 0) {
      best_ = cover{cost, chosen_};
      return;
    }
    for (auto i = from; i < offers_.size(); ++i) {
      // The one before, which is the same, was tried instead.
      if (i > from && is_same(i - 1, i))
        continue;
      const auto& x = *offers_[i];
      auto after = lack;
      for (std::size_t r = 0; r < after.size(); ++r)
        after[r] -= x.gives[r];
      auto more = cost;
      more.add(x.priority);
      chosen_.push_back(x.position);
      choose(i + 1, left - 1, more, after);
      chosen_.pop_back();
    }
  }

  bool is_same(std::size_t i, std::size_t k) const {
    return offers_[i]->priority == offers_[k]->priority
           && offers_[i]->gives == offers_[k]->gives;
  }

  amounts shortage_;
  std::vector<const offer*> offers_;
  std::vector<amounts> largest_; ///< The most that one gives from there on.
  std::vector<std::size_t> chosen_;
  std::optional<cover> best_;
};

// -- one node ---------------------------------------------------------------

preemption_search::preemption_search(const problem& asked, std::size_t node)
    : unified_(asked.nodes[node].unified_memory) {
  const auto& host = asked.nodes[node];
  for (const auto* x : {&host.cpu, &host.memory_mib, &host.disk_mib})
    spare_.push_back(x->capacity - x->used);
  for (const auto& card : host.gpus) {
    gpus_.push_back(card.index);
    spare_.push_back(card.memory_mib.capacity - card.memory_mib.used);
  }
}

void preemption_search::add(std::size_t position, const holder& given) {
  amounts gives(spare_.size(), 0);
  gives[cpu] = given.cpu;
  gives[memory] = given.memory_mib;
  gives[disk] = given.disk_mib;
  const auto card = std::find(gpus_.begin(), gpus_.end(), given.gpu);
  if (unified_)
    gives[memory] += given.gpu_memory_mib;
  else if (card != gpus_.end())
    gives[first_gpu + static_cast<std::size_t>(card - gpus_.begin())] +=
        given.gpu_memory_mib;
  offers_.push_back({position, given.priority, std::move(gives)});
}

void preemption_search::sort() {
  std::sort(offers_.begin(), offers_.end(), [](const auto& x, const auto& y) {
    return std::tie(x.priority, x.gives, x.position)
           < std::tie(y.priority, y.gives, y.position);
  });
}

amounts preemption_search::demand_of(const deployment& way,
                                     const candidate& choice) const {
  amounts result(spare_.size(), 0);
  result[cpu] = way.cpu;
  result[memory] = way.memory_mib;
  result[disk] = way.disk_mib;
  if (unified_)
    result[memory] += way.gpu_memory_mib;
  else if (choice.gpu >= 0)
    result[first_gpu + static_cast<std::size_t>(choice.gpu)] +=
        way.gpu_memory_mib;
  return result;
}

const std::optional<cover>& preemption_search::cover_of(const amounts& demand) {
  auto [known, is_new] = known_.try_emplace(demand);
  if (!is_new)
    return known->second;
  amounts shortage(demand.size(), 0);
  for (std::size_t r = 0; r < demand.size(); ++r)
    shortage[r] = demand[r] > 0 ? std::max(0.0, demand[r] - spare_[r]) : 0;
  known->second = chooser(offers_, std::move(shortage)).run();
  return known->second;
}

} // namespace roscell::allocation
