#include "tools/roscell/view/plan_view.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

std::string fraction(double value) {
  return value < 0 ? "" : format_significant(value, 4);
}

std::string score(double value) {
  return format_significant(value, 6);
}

std::string steps_view(const std::vector<step_allocation>& allocations,
                       const text_style& style) {
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
  for (const auto& a : allocations)
    t.rows.push_back(
        {a.step, a.node, a.deployment, a.gpu < 0 ? "" : std::to_string(a.gpu),
         fraction(a.fractions.cpu), fraction(a.fractions.memory),
         fraction(a.fractions.disk), fraction(a.fractions.gpu_memory),
         score(a.variance), score(a.bonus)});
  return t.render(style);
}

std::string score_view(const allocation_score& of) {
  return score(of.total) + " = balance " + score(of.balance) + " + "
         + score(of.alpha) + " * load " + score(of.load);
}

std::string verdict_view(const task_plan& plan) {
  if (plan.optimal)
    return "optimal";
  return "best found, not proven optimal: no total is below "
         + score(plan.score.lower_bound) + ", a gap of "
         + score(plan.score.gap);
}

/// What is used already as '#', what the steps add as '+'.
std::string bar_of(const resource_use& of) {
  constexpr size_t columns = 20;
  const auto before = std::min(of.before, of.capacity);
  const auto added = std::max(0.0, std::min(of.after, of.capacity) - before);
  line x;
  x.spans = bar({before, added, of.capacity}, columns, false);
  return "[" + text_of(x) + "]";
}

std::string percent(double amount, double capacity) {
  return capacity > 0 ? format_number(100 * amount / capacity, 0) + "%" : "";
}

std::string amount_of(double value, const std::string& resource) {
  return resource == "cpu" ? format_number(value) : format_mib(value);
}

std::string use_view(const std::vector<resource_use>& use,
                     const text_style& style) {
  table t{{{"NODE"},
           {"RESOURCE"},
           {"USE"},
           {"BEFORE", align::right},
           {"AFTER", align::right},
           {"OF", align::right},
           {"BEFORE", align::right},
           {"AFTER", align::right}},
          {}};
  for (const auto& x : use)
    t.rows.push_back(
        {x.node, x.resource, bar_of(x), amount_of(x.before, x.resource),
         amount_of(x.after, x.resource), amount_of(x.capacity, x.resource),
         percent(x.before, x.capacity), percent(x.after, x.capacity)});
  return t.render(style);
}

/// The placements of an alternative that differ from those of the plan.
std::vector<step_allocation> moved(const task_plan& plan,
                                   const step_alternative& other) {
  std::vector<step_allocation> result;
  for (size_t i = 0; i < other.allocations.size(); ++i) {
    const auto& x = other.allocations[i];
    const auto& y = plan.allocations[i];
    if (x.node != y.node || x.deployment != y.deployment || x.gpu != y.gpu)
      result.push_back(x);
  }
  return result;
}

std::string alternative_view(const task_plan& plan,
                             const step_alternative& other,
                             const text_style& style) {
  const auto step = "step '" + printable(other.step) + "'";
  if (!other.obstacle.empty())
    return "why: " + step + " can be nowhere else: " + printable(other.obstacle)
           + "\n";
  return "why: the best alternative for " + step + " costs "
         + score(other.extra) + " more" + (other.optimal ? "" : " at most")
         + ": " + score_view(other.score) + "\n\n"
         + steps_view(moved(plan, other), style);
}

} // namespace

std::vector<rejected_candidate> rejected_in(const failure& why) {
  const auto details = json::parse(why.details, nullptr, false);
  if (!details.is_object() || !details.contains("rejected"))
    return {};
  return details["rejected"].get<std::vector<rejected_candidate>>();
}

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
  auto text = "task " + printable(plan.task) + ", " + verdict_view(plan)
              + "\n\n" + steps_view(plan.allocations, style);
  text += "\nscore " + score_view(plan.score) + "\n";
  text += "columns CPU to GPU MEMORY: fraction of what was free\n";
  for (const auto& x : plan.preempted)
    text += printable("would be preempted: " + x.task + "/" + x.step + " on "
                      + x.node)
            + ", priority " + std::to_string(x.priority) + "\n";
  for (const auto& warning : plan.warnings)
    text += "warning: " + printable(warning) + "\n";
  if (!plan.use.empty())
    text +=
        "\n" + use_view(plan.use, style) + "USE: # before, + with this task\n";
  for (const auto& other : plan.alternatives)
    text += "\n" + alternative_view(plan, other, style);
  return text + "\n" + rejected_view(plan.rejected, style);
}

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
