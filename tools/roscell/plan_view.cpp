#include "tools/roscell/plan_view.hpp"

#include "tools/roscell/format.hpp"

namespace roscell::cli {

namespace {

std::string fraction(double value) {
  return value < 0 ? "" : format_significant(value, 4);
}

std::string score(double value) {
  return format_significant(value, 6);
}

std::string steps_view(const task_plan& plan, const text_style& style) {
  table t{{{"STEP"},
           {"NODE"},
           {"DEPLOYMENT"},
           {"GPU", align::right},
           {"CPU", align::right},
           {"MEMORY", align::right},
           {"DISK", align::right},
           {"GPU MEMORY", align::right},
           {"VARIANCE", align::right},
           {"BONUS", align::right}},
          {}};
  for (const auto& a : plan.allocations)
    t.rows.push_back(
        {a.step, a.node, a.deployment, a.gpu < 0 ? "" : std::to_string(a.gpu),
         fraction(a.fractions.cpu), fraction(a.fractions.memory),
         fraction(a.fractions.disk), fraction(a.fractions.gpu_memory),
         score(a.variance), score(a.bonus)});
  return t.render(style);
}

} // namespace

std::string rejected_view(const std::vector<rejected_candidate>& rejected,
                          const text_style& style) {
  if (rejected.empty())
    return "no rejected candidates\n";
  table t{{{"STEP"}, {"NODE"}, {"DEPLOYMENT"}, {"REJECTED BECAUSE"}}, {}};
  for (const auto& r : rejected) {
    std::string reasons;
    for (const auto& reason : r.reasons)
      reasons += (reasons.empty() ? "" : "; ") + reason;
    t.rows.push_back({r.step, r.node, r.deployment, reasons});
  }
  return t.render(style);
}

std::string plan_view(const task_plan& plan, const text_style& style) {
  auto text = "task " + printable(plan.task) + ", "
              + (plan.optimal ? "optimal" : "best found, not proven optimal")
              + "\n\n" + steps_view(plan, style);
  text += "\nscore " + score(plan.score.total) + " = balance "
          + score(plan.score.balance) + " + alpha * load "
          + score(plan.score.load) + "\n";
  text += "columns CPU to GPU MEMORY: fraction of what was free\n";
  for (const auto& warning : plan.warnings)
    text += "warning: " + printable(warning) + "\n";
  return text + "\n" + rejected_view(plan.rejected, style);
}

} // namespace roscell::cli
