#include "tools/roscell/tasks/rebalance_view.hpp"

#include "tools/roscell/view/format.hpp"

namespace roscell::cli {

namespace {

std::string number(double value) {
  return format_significant(value, 4);
}

std::string bound_text(const cell_rebalanced& report) {
  if (report.optimal)
    return "no placement is better";
  return "no placement is below " + number(report.lower_bound);
}

} // namespace

std::string rebalance_view(const cell_rebalanced& report,
                           const text_style& style) {
  const auto cell = "cell '" + printable(report.cell) + "': ";
  if (report.moves.empty())
    return cell + "no move is worth it; total " + number(report.before) + ", "
           + bound_text(report) + "\n";
  table t{{{"MOVE", align::right},
           {"TASK"},
           {"STEP"},
           {"FROM"},
           {"TO"},
           {"GAIN", align::right},
           {"STATE"}},
          {}};
  for (size_t i = 0; i < report.moves.size(); ++i) {
    const auto& x = report.moves[i];
    t.rows.push_back({std::to_string(i + 1), x.task, x.step, x.from, x.to,
                      number(x.gain), std::string{to_word(x.state)}});
  }
  return t.render(style) + "\n" + cell + "total " + number(report.before)
         + " -> " + number(report.after) + ", " + bound_text(report) + "\n";
}

} // namespace roscell::cli
