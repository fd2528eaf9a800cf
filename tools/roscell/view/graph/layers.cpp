#include "tools/roscell/view/graph/layers.hpp"

#include <algorithm>
#include <numeric>

namespace roscell::cli {

std::vector<std::vector<size_t>>
components(size_t boxes, const std::vector<graph_arc>& arcs) {
  std::vector<size_t> group(boxes);
  std::iota(group.begin(), group.end(), size_t{0});
  for (const auto& [from, to] : arcs) {
    const auto kept = std::min(group[from], group[to]);
    const auto joined = std::max(group[from], group[to]);
    std::replace(group.begin(), group.end(), joined, kept);
  }
  std::vector<std::vector<size_t>> result;
  for (size_t first = 0; first < boxes; ++first) {
    std::vector<size_t> members;
    for (size_t i = 0; i < boxes; ++i)
      if (group[i] == first)
        members.push_back(i);
    if (!members.empty())
      result.push_back(std::move(members));
  }
  return result;
}

namespace {

/// Walks the arcs, and leaves out those that lead back to where it has come
/// from.
class arc_walk {
public:
  arc_walk(size_t boxes, const std::vector<graph_arc>& arcs)
      : arcs_{arcs}, state_(boxes, unseen) {
    for (size_t i = 0; i < boxes; ++i)
      visit(i);
  }

  std::vector<graph_arc> forward;

private:
  enum state { unseen, open, done };

  void visit(size_t box) {
    if (state_[box] != unseen)
      return;
    state_[box] = open;
    for (const auto& arc : arcs_) {
      if (arc.first != box || state_[arc.second] == open)
        continue;
      forward.push_back(arc);
      visit(arc.second);
    }
    state_[box] = done;
  }

  const std::vector<graph_arc>& arcs_;
  std::vector<state> state_;
};

} // namespace

std::vector<size_t> layers(size_t boxes, const std::vector<graph_arc>& arcs) {
  const arc_walk walk{boxes, arcs};
  std::vector<size_t> result(boxes, 0);
  // Without circles no path has more arcs than there are boxes.
  for (size_t round = 0; round < boxes; ++round)
    for (const auto& [from, to] : walk.forward)
      result[to] = std::max(result[to], result[from] + 1);
  return result;
}

} // namespace roscell::cli
