#include "actors/cell/moves/lost_remains.hpp"

#include "actors/cell/tasks/task_removals.hpp"

namespace roscell {

using std::chrono::milliseconds;

namespace {

/// Whether its node can be told to end it.
bool is_back(const cell_coordinator_state& st, const lost_step& x) {
  const auto* node = st.registry.find_name(x.node);
  return node && node->agent && node->row.identity.uuid == x.uuid;
}

std::optional<milliseconds> fenced_for(coordinator_pointer self,
                                       const lost_step& x) {
  const auto left =
      std::chrono::ceil<milliseconds>(x.ended_by - self->clock().now());
  return left.count() > 0 ? std::optional{left} : std::nullopt;
}

failure still_there(const std::string& instance, const std::string& node,
                    const std::string& why, const std::string& when) {
  return {error_code::conflict,
          "'" + instance + "' of the task that had this name may still run "
              + "on '" + node + "': " + why,
          "/task", "send it again " + when + ", or choose another task id"};
}

} // namespace

bool may_move(const instance_spec& x) {
  return x.life.on_node_loss.policy == loss_action::move;
}

bool starts_alone(const instance_spec& x) {
  return boot_action_of(x.life) == boot_action::start;
}

bool is_left_over(const cell_coordinator_state& st, const instance_row& row) {
  return is_live(row.state) && !st.deployments.find(row.spec.instance)
         && (may_move(row.spec) || starts_alone(row.spec));
}

failure may_start_alone(const std::string& instance, const std::string& node) {
  return {error_code::conflict,
          "'" + instance + "' is started by node '" + node
              + "' alone, as soon as its host is switched on",
          "/task",
          "wait for the node; if its host stays off, stop the task, and run it "
          "with --force"};
}

std::optional<milliseconds> may_run_on(coordinator_pointer self,
                                       const std::string& instance) {
  const auto& st = self->state;
  const auto* lost = st.losses.find(instance);
  return lost && !lost->is_alone && !is_back(st, *lost)
             ? fenced_for(self, *lost)
             : std::nullopt;
}

std::optional<failure> remains_of(coordinator_pointer self,
                                  const std::string& task, bool force) {
  auto& st = self->state;
  for (const auto& x : st.losses.of_task(task)) {
    if (x.is_alone && force)
      st.losses.forget(x.instance);
    else if (x.is_alone)
      return may_start_alone(x.instance, x.node);
    if (x.is_alone)
      continue;
    const auto left = is_back(st, x) ? std::nullopt : fenced_for(self, x);
    if (!left)
      continue;
    const auto s = std::chrono::ceil<std::chrono::seconds>(*left).count();
    return still_there(x.instance, x.node, "its node is away",
                       "in " + std::to_string(s)
                           + " s, when it has been ended there");
  }
  for (const auto& row : st.deployments.rows_of(task))
    if (is_left_over(st, row) && !is_away(st, row.node))
      return still_there(row.spec.instance, row.node,
                         "its node was away, and is ending it",
                         "once it has ended");
  return std::nullopt;
}

} // namespace roscell
