#include "client/columns.hpp"

namespace roscell {

namespace {

/// Where a window is narrow the page leaves out what has this rank or more.
constexpr int minor_rank = 3;

template <class Row>
json described(const column_list<Row>& columns) {
  json result = json::array();
  for (const auto& x : columns)
    if (*x.said_as != '\0')
      result.push_back({{"name", x.what.name},
                        {"as", x.said_as},
                        {"path", x.path},
                        {"number", x.what.side == align::right},
                        {"minor", x.what.rank >= minor_rank && !x.what.whole
                                      && x.what.rank != only_wide}});
  return result;
}

} // namespace

json described_columns() {
  return {{"nodes", described(node_columns())},
          {"tasks", described(task_columns())},
          {"instances", described(instance_columns())},
          {"topics", described(topic_columns())}};
}

} // namespace roscell
