#include "test/site/watch/task_watch.hpp"

#include <algorithm>

namespace roscell::test {

namespace {

bool has_step(const std::vector<task_view>& tasks, const std::string& instance,
              const std::string& node) {
  return std::any_of(tasks.begin(), tasks.end(), [&](const auto& task) {
    return std::any_of(task.steps.begin(), task.steps.end(),
                       [&](const auto& x) {
                         return x.instance == instance && x.node == node;
                       });
  });
}

const site_task* find_task(const site& place, size_t cell,
                           const std::string& name) {
  for (const auto& x : place.tasks)
    if (x->cell == cell && x->name == name)
      return x.get();
  return nullptr;
}

/// Whether the step goes elsewhere by itself when its node is lost.
bool moves_by_itself(const site_task* task, const std::string& step) {
  if (!task)
    return false;
  for (const auto& x : task->request.at("pipeline"))
    if (x.at("id") == step)
      return x.contains("on_node_loss");
  return false;
}

} // namespace

void task_watch::span_table::update(const std::set<key>& present, moment now) {
  for (auto i = since.begin(); i != since.end();)
    i = present.count(i->first) == 0 ? since.erase(i) : std::next(i);
  for (const auto& x : present) {
    const auto begin = since.emplace(x, now).first->second;
    longest =
        std::max(longest, std::chrono::duration_cast<duration>(now - begin));
  }
}

void task_watch::look() {
  std::set<key> doubled, stray;
  std::map<size_t, snapshot> now;
  check_events();
  for (const auto& c : place_.parties) {
    if (!c->coordinates || !c->alive())
      continue;
    const auto tasks = tasks_of(*c);
    check_programs(*c, tasks, doubled, stray);
    auto& x = now[c->index];
    x.life = c->life;
    for (const auto& task : tasks) {
      if (task.state != task_state::deploying
          && task.state != task_state::terminating)
        x.running.insert(task.task);
      for (const auto& step : task.steps)
        if (!step.ended && task.state != task_state::terminating)
          x.placed.emplace(task.task, step.node);
    }
    check_ends(*c, x);
  }
  seen_ = std::move(now);
  doubles_.update(doubled, place_.now());
  strays_.update(stray, place_.now());
  for (size_t i = 0; i < place_.requests.size(); ++i)
    if (place_.requests[i].is_answered())
      answered_.insert(i);
}

void task_watch::check_programs(const site_party& coordinator,
                                const std::vector<task_view>& tasks,
                                std::set<key>& doubled,
                                std::set<key>& stray) const {
  std::map<key, size_t> nodes; ///< On which a step runs.
  for (const auto& node : place_.parties) {
    if (node->programs.empty() || !are_cell(coordinator, *node))
      continue;
    for (const auto& [instance, x] : node->programs) {
      if (x.cell != coordinator.cell || !x.runs(place_.now()))
        continue;
      const key step{coordinator.index, x.task, x.step};
      if (++nodes[step] > 1)
        doubled.insert(step);
      if (!has_step(tasks, instance, node->name))
        stray.emplace(node->index, instance, "");
    }
  }
}

/// A request that was definitely refused does nothing more.
bool task_watch::may_still_act(const site_request& x,
                               size_t coordinator) const {
  const auto number = static_cast<size_t>(&x - place_.requests.data());
  if (x.closed || answered_.count(number) == 0)
    return true;
  const auto why = x.refusal();
  return !why || why->code == error_code::unresolved
         || why->code == error_code::timeout
         || (why->code == error_code::unreachable && x.asked != coordinator);
}

bool task_watch::is_wanted(instance_policy policy, size_t coordinator) const {
  return std::any_of(
      place_.requests.begin(), place_.requests.end(), [&](const auto& x) {
        return x.policy == policy && may_still_act(x, coordinator);
      });
}

/// A task that runs ends only if somebody wants it.
void task_watch::check_ends(const site_party& coordinator,
                            const snapshot& now) {
  const auto i = seen_.find(coordinator.index);
  if (i == seen_.end() || i->second.life != now.life)
    return;
  for (const auto& task : i->second.running) {
    if (now.running.count(task) > 0)
      continue;
    const auto* asked = find_task(place_, coordinator.index, task);
    if ((!asked || !asked->end_is_wanted())
        && !is_wanted(instance_policy::terminate, coordinator.index))
      place_.report_violation("task '" + task + "' of " + coordinator.cell
                              + " is ended, and nobody wants that");
  }
}

void task_watch::check_events() {
  for (; events_seen_ < place_.events.size(); ++events_seen_) {
    const auto& event = place_.events[events_seen_];
    if (event.what == "node_departing")
      check_departure(event);
    else if (event.what == "instance_moved")
      check_moved_step(event);
    else if (event.what == "transfer_ended"
             && !ended_transfers_
                     .emplace(event.party, event.data.at("transfer"),
                              std::to_string(event.life))
                     .second)
      place_.report_violation("transfer "
                              + event.data.at("transfer").get<std::string>()
                              + " has ended twice");
  }
}

/// A node that has something to do, or will have, is not let go unless somebody
/// has said what shall become of it.
void task_watch::check_departure(const site_event& event) {
  const auto quoted = '"' + event.subject + '"';
  for (const auto& x : place_.requests)
    if (x.policy != instance_policy::refuse
        && x.text.find(quoted) != std::string::npos)
      return;
  const auto& c = *place_.parties[event.party];
  const auto before = seen_.find(c.index);
  if (!c.alive() || before == seen_.end() || before->second.life != c.life)
    return;
  for (const auto& task : tasks_of(c))
    for (const auto& step : task.steps)
      if (step.node == event.subject && !step.ended
          && before->second.placed.count({task.task, step.node}) > 0)
        place_.report_violation("'" + step.instance + "' is on node '"
                                + event.subject + "', which is let go");
}

/// One that was lost has ended on its node, wherever that is and whatever it
/// believes, before it runs elsewhere.
void task_watch::check_loss(const std::string& old, const std::string& from) {
  const auto* node = find_party(place_, from);
  if (!node)
    return;
  const auto found = node->programs.find(old);
  if (found != node->programs.end() && found->second.runs(place_.now()))
    place_.report_violation("'" + old + "' runs on on " + from
                            + ", and elsewhere too");
}

/// A task that is asked for once more has started again what had failed, as its
/// coordinator knew.
bool task_watch::is_healed(const site_event& event) const {
  const auto* task = find_task(place_, event.party, event.data.at("task"));
  const auto asked = [](const auto& x) { return !x.ends; };
  if (!task || std::count_if(task->calls.begin(), task->calls.end(), asked) < 2)
    return false;
  const auto end = place_.events.begin() + static_cast<ptrdiff_t>(events_seen_);
  return std::any_of(place_.events.begin(), end, [&](const auto& x) {
    return x.what == "instance_changed" && x.party == event.party
           && x.subject == event.data.at("replaces")
           && x.data.value("state", "") == "failed";
  });
}

void task_watch::check_moved_step(const site_event& event) {
  const auto old = event.data.at("replaces").get<std::string>();
  const auto* task = find_task(place_, event.party, event.data.at("task"));
  // One that is wanted to go runs until the new one does.
  const bool is_asked = is_wanted(instance_policy::reschedule, event.party);
  if (!is_asked
      && (moves_by_itself(task, event.data.at("step")) || is_healed(event)))
    check_loss(old, event.data.at("from"));
  else if (!is_asked)
    place_.report_violation("'" + event.subject
                            + "' is moved, and nobody wants that");
  const auto end = place_.events.begin() + static_cast<ptrdiff_t>(events_seen_);
  const bool known =
      std::any_of(place_.events.begin(), end, [&](const auto& x) {
        return x.what == "instance_changed" && x.party == event.party
               && x.subject == old && x.data.value("state", "") == "stopped"
               && x.data.value("exit_code", -1) == 0;
      });
  if (known && place_.finished.count(old) > 0)
    place_.report_violation("'" + old + "' has finished and is moved");
}

} // namespace roscell::test
