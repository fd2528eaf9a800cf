#pragma once

#include "actors/placement/search/occupancy.hpp"
#include "actors/placement/search/running/eviction.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace roscell::allocation {

/// How many holders of each priority go. Fewer are cheaper; of equally many
/// those are whose highest priorities are lower. Prices add up over nodes.
class price {
public:
  void add(int priority, int times = 1) {
    count_ += times;
    of_[static_cast<std::size_t>(priority)] += times;
  }
  price& operator+=(const price& other);
  price& operator-=(const price& other);
  bool operator<(const price& other) const;

private:
  int count_ = 0;
  std::array<int, priorities> of_{}; ///< By priority.
};

/// What of a node must go for a demand.
struct cover {
  price cost;
  std::vector<std::size_t> holders;
};

/// CPU, memory, disk, then the memory of each GPU in the node's order. On
/// unified memory a GPU's is part of the node's.
using amounts = std::vector<double>;

/// Finds the cheapest way to make room on one node.
class preemption_search {
public:
  preemption_search(const problem& asked, std::size_t node);

  /// Adds one of the node's holders, by its position in the caller's list.
  void add(std::size_t position, const holder& given);

  /// To be called once all are added.
  void sort();

  bool is_empty() const {
    return offers_.empty();
  }

  /// What one step asks for.
  amounts demand_of(const deployment& way, const candidate& choice) const;

  /// The cheapest cover; nothing where all of them are not enough. What is not
  /// asked for needs no room, even if others use too much of it.
  const std::optional<cover>& cover_of(const amounts& demand);

private:
  struct offer {
    std::size_t position;
    int priority;
    amounts gives;
  };
  class chooser;

  bool unified_;
  std::vector<int> gpus_; ///< Their indices.
  amounts spare_;         ///< Negative where more is in use than there is.
  std::vector<offer> offers_;
  std::map<amounts, std::optional<cover>> known_;
};

} // namespace roscell::allocation
