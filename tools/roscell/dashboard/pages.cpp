#include "tools/roscell/dashboard/pages.hpp"

#include "client/cell_model.hpp"
#include "client/columns.hpp"

namespace roscell::cli {

const std::string& described_script() {
  static const auto text =
      "export const COLUMNS = " + described_columns().dump()
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
