#include "actors/cell/tasks/step_order.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

/// An output of one step is the input of another where both are the same.
using stream_key = std::pair<std::string_view, std::string_view>;

stream_key key_of(const io_endpoint& x) {
  return {x.protocol, x.endpoint};
}

/// Walks from the writers of streams to their readers, and leaves out what
/// leads back to where it has come from.
class flow_walk {
public:
  explicit flow_walk(const std::vector<instance_row>& steps)
      : steps_{steps}, state_(steps.size(), unseen), onward_(steps.size()) {
    for (size_t i = 0; i < steps.size(); ++i)
      for (const auto& x : steps[i].spec.input)
        readers_[key_of(x)].push_back(i);
    for (size_t i = 0; i < steps.size(); ++i)
      visit(i);
  }

  /// Of each step how many lie before it on the longest way to it.
  std::vector<size_t> layers() const {
    std::vector<size_t> result(steps_.size(), 0);
    for (auto from = done_.rbegin(); from != done_.rend(); ++from)
      for (const auto to : onward_[*from])
        result[to] = std::max(result[to], result[*from] + 1);
    return result;
  }

private:
  enum state { unseen, open, done };

  void visit(size_t step) {
    if (state_[step] != unseen)
      return;
    state_[step] = open;
    for (const auto& output : steps_[step].spec.output)
      if (const auto found = readers_.find(key_of(output));
          found != readers_.end())
        for (const auto reader : found->second)
          if (state_[reader] != open) {
            onward_[step].push_back(reader);
            visit(reader);
          }
    state_[step] = done;
    done_.push_back(step);
  }

  const std::vector<instance_row>& steps_;
  std::map<stream_key, std::vector<size_t>> readers_;
  std::vector<state> state_;
  std::vector<std::vector<size_t>> onward_;
  std::vector<size_t> done_; // Each behind all that are reached from it.
};

} // namespace

void sort_by_flow(std::vector<instance_row>& steps) {
  const auto layers = flow_walk{steps}.layers();
  std::vector<size_t> order(steps.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t x, size_t y) { return layers[x] < layers[y]; });
  std::vector<instance_row> sorted;
  sorted.reserve(steps.size());
  for (const auto i : order)
    sorted.push_back(std::move(steps[i]));
  steps = std::move(sorted);
}

} // namespace roscell
