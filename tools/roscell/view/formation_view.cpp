#include "tools/roscell/view/formation_view.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// A released node goes to no cell. No cell can have this name.
std::string destination(const std::string& cell) {
  return cell.empty() ? "(independent)" : cell;
}

std::string moved_view(const std::vector<cell>& row, const view_style& style) {
  const table t{{{"NODE"},
                 {"FROM"},
                 {"TO"},
                 {"TRANSFER"},
                 {"TASKS TERMINATED"},
                 {"TASKS RESCHEDULED"}},
                {row}};
  return t.render(style.text);
}

} // namespace

std::string formation_view(const cell_formed& formed, const view_style& style) {
  table t{{{"NODE"}, {"RESULT"}, {"FROM"}, {"MESSAGE"}}, {}};
  for (const auto& x : formed.outcomes)
    t.rows.push_back(
        {x.node, to_string(x.result), x.from,
         x.code.empty() ? x.message : x.message + " (" + x.code + ")"});
  return t.render(style.text);
}

std::vector<std::string> hints_of(const cell_formed& formed) {
  std::vector<std::string> result;
  for (const auto& x : formed.outcomes)
    if (!x.hint.empty()
        && std::find(result.begin(), result.end(), x.hint) == result.end())
      result.push_back(x.hint);
  return result;
}

std::string transferred_view(const node_transferred& moved,
                             const view_style& style) {
  return moved_view({moved.node, moved.from, moved.to, moved.transfer,
                     joined(moved.terminated), joined(moved.rescheduled)},
                    style);
}

std::string released_view(const node_released& moved, const view_style& style) {
  return moved_view({moved.node, moved.cell, destination(""), moved.transfer,
                     joined(moved.terminated), joined(moved.rescheduled)},
                    style);
}

std::string transfers_view(const transfer_description& transfers,
                           const view_style& style) {
  table t{{{"TRANSFER"},
           {"NODE"},
           {"FROM", align::left, 2},
           {"TO", align::left, 2},
           {"STATE"},
           {"SINCE", align::right, 3},
           {"REASON", align::left, 1}},
          {}};
  for (const auto& row : transfers.transfers)
    t.rows.push_back({row.transfer, row.node, row.from, destination(row.to),
                      to_string(row.state),
                      format_since(row.since_unix_ms, style.now_unix_ms),
                      row.reason});
  return t.rows.empty() ? "no transfers\n" : t.render(style.text);
}

} // namespace roscell::cli
