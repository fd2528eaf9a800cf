#include "tools/roscell/dashboard/pages.hpp"

#include "client/cell_model.hpp"
#include "tools/roscell/view/columns.hpp"

namespace roscell::cli {

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

const std::string& described_script() {
  static const auto text =
      "export const COLUMNS = "
      + json{{"nodes", described(node_columns())},
             {"tasks", described(task_columns())},
             {"instances", described(instance_columns())},
             {"topics", described(topic_columns())}}
            .dump()
      + ";\nexport const STALE = " + json(stale_answers()).dump() + ";\n";
  return text;
}

const web_pages& dashboard_pages() {
  static const auto all = [] {
    auto result = page_files();
    result["/dashboard/described.js"] = {"text/javascript; charset=utf-8",
                                         described_script()};
    return result;
  }();
  return all;
}

} // namespace roscell::cli
