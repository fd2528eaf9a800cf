#include "actors/placement/search_guard.hpp"

#include <utility>

namespace roscell {

void search_guard::begin(std::set<std::string> nodes) {
  const std::lock_guard<std::mutex> lock{mutex_};
  nodes_ = std::move(nodes);
  gone_.clear();
  stopped_ = false;
}

void search_guard::node_left(const std::string& node) {
  const std::lock_guard<std::mutex> lock{mutex_};
  if (nodes_.count(node) == 0 || stopped_)
    return;
  gone_ = node;
  stopped_ = true;
}

std::string search_guard::end() {
  const std::lock_guard<std::mutex> lock{mutex_};
  nodes_.clear();
  return std::exchange(gone_, {});
}

} // namespace roscell
