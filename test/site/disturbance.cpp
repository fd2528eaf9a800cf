#include "test/site/disturbance.hpp"

#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"
#include "test/site/site_skills.hpp"
#include "test/site/watch/task_rest.hpp"

#include <algorithm>

namespace roscell::test {

namespace {

/// Longer than the wait for the answer to a registration, and shorter than a
/// lease.
constexpr std::chrono::milliseconds held_for{5500};

} // namespace

disturbance::disturbance(virtual_time& clock, uint32_t seed)
    : place_(clock, seed), watch_(place_), hostile_(seed % 2 == 0),
      has_tasks_(!hostile_) {
  // Belonging to a cell survives a wire that loses and reorders frames, which
  // TCP never does. What a node tells of its instances counts on TCP.
  add_parties();
  add_faults();
}

void disturbance::add_faults() {
  auto& x = place_.faults;
  x.drop_heartbeat = 0.1 * static_cast<double>(pick(4));
  x.repeat_heartbeat = 0.1 * static_cast<double>(pick(4));
  x.longest_delay = std::chrono::milliseconds{pick(3) * 40};
  x.repeat_frame = 0.1 * static_cast<double>(pick(4));
  x.cut = 0.02 * static_cast<double>(pick(3));
  x.hold_frame = 0.02 * static_cast<double>(pick(4));
  x.late_by = held_for;
  holds_ = x.hold_frame > 0;
  place_.drop_call = 0.1 * static_cast<double>(pick(3));
  // What TCP never does: a frame is lost, and what follows arrives.
  x.drop_frame = hostile_ ? 0.05 * static_cast<double>(pick(4)) : 0;
  x.reorder = hostile_ && pick(2) == 0;
}

void disturbance::run() {
  for (auto& x : place_.parties)
    if (pick(4) > 0)
      place_.start(*x);
  watch_.live(5s);
  const auto steps = 3 + pick(15);
  for (size_t i = 0; i < steps; ++i) {
    disturb();
    const duration span{pick(3) == 0 ? pick(12'000) : pick(900)};
    // Nothing happens to a party that has been started until it has begun.
    watch_.live(std::max(span, duration{1}));
  }
  if (pick(6) == 0)
    some_node().retired = true;
  for (auto& x : place_.parties)
    if (x->retired)
      place_.kill(*x);
}

// -- who is there ------------------------------------------------------------

void disturbance::add_parties() {
  coordinators_ = 2 + pick(2);
  // Whose UUID is the lowest must not depend on the order of starts.
  const auto shift = pick(coordinators_);
  for (size_t i = 0; i < coordinators_; ++i)
    place_.add_coordinator("c-" + std::to_string((i + shift) % coordinators_));
  const auto nodes = 1 + pick(4);
  for (size_t i = 0; i < nodes; ++i) {
    const auto how = pick(4);
    if (how == 0)
      place_.add_node("wait");
    else if (how == 1)
      place_.add_node(some_coordinator().discovery_server);
    else
      place_.add_node();
  }
  if (has_tasks_)
    for (auto& x : place_.parties)
      x->build_takes = duration{pick(3) * 400};
}

site_party& disturbance::some_party() {
  return *place_.parties[pick(place_.parties.size())];
}

site_party& disturbance::some_coordinator() {
  return *place_.parties[pick(coordinators_)];
}

site_party& disturbance::some_node() {
  const auto nodes = place_.parties.size() - coordinators_;
  return *place_.parties[coordinators_ + pick(nodes)];
}

// -- what breaks -------------------------------------------------------------

void disturbance::disturb() {
  const auto what = pick(has_tasks_ ? 24 : 16);
  if (what < 4)
    disturb_party();
  else if (what < 10)
    disturb_network();
  else if (what == 10)
    disturb_machine();
  else if (what < 16)
    operate_nodes();
  else
    operate_tasks();
}

void disturbance::disturb_party() {
  switch (pick(5)) {
  case 0:
    return place_.kill(some_coordinator());
  case 1:
  case 2:
    return place_.start(some_party());
  case 3:
    return pick(2) == 0 ? place_.freeze(some_party())
                        : place_.thaw(some_party());
  default: {
    auto& x = some_node();
    if (!x.alive())
      return place_.start(x);
    // What waits for room on its disk would be lost: it would come back as a
    // node that was never in a cell.
    if (x.disk_full || !x.waiting.empty())
      return;
    return pick(3) == 0 ? place_.crash(x) : place_.kill(x);
  }
  }
}

void disturbance::disturb_machine() {
  auto& x = some_party();
  if (has_tasks_ && pick(2) == 0)
    x.builds_fail = !x.builds_fail;
  else
    x.disk_full = !x.disk_full;
}

void disturbance::disturb_network() {
  switch (pick(7)) {
  case 0:
  case 1:
    return disturb_wire();
  case 2:
    return split();
  case 3:
    return place_.heal_all();
  case 4:
    return place_.cut_one_way(some_party().index, some_party().index);
  case 5:
    return place_.block(some_party().index, some_party().index);
  default:
    return place_.hide(some_party().index, some_party().index);
  }
}

void disturbance::disturb_wire() {
  if (place_.connections.empty())
    return;
  auto& link = *place_.connections[pick(place_.connections.size())].link;
  switch (pick(3)) {
  case 0:
    return cut(link);
  case 1:
    link.silent = true;
    return;
  default:
    heal(link);
  }
}

void disturbance::split() {
  std::vector<int> sides;
  for (size_t i = 0; i < place_.parties.size(); ++i)
    sides.push_back(static_cast<int>(pick(2)));
  place_.split(sides);
}

// -- what operators want -----------------------------------------------------

/// One or two operators want something, of the same node.
void disturbance::operate_nodes() {
  const auto& node = some_node();
  const auto askers = 1 + pick(2);
  for (size_t i = 0; i < askers; ++i)
    ask(some_coordinator(), node.name);
}

void disturbance::ask(const site_party& whom, const std::string& node) {
  if (!whom.alive())
    return;
  const auto request = pick(6);
  const auto policy = static_cast<instance_policy>(has_tasks_ ? pick(3) : 0);
  if (request < 3)
    place_.ask<node_transferred>(
        whom, node_transfer{node, some_coordinator().cell, policy});
  else if (request == 3)
    place_.ask<node_released>(whom, node_release{node, policy});
  else if (request == 4)
    place_.ask<cell_formed>(whom, cell_formation{{node}, policy});
  else
    place_.ask<cell_formed>(
        whom, cell_formation{{some_node().name, "nobody", node, node}, policy});
}

program_script disturbance::some_script() {
  program_script x;
  x.ready_ms = pick(10) == 0 ? -1 : static_cast<int64_t>(pick(2000));
  x.ends_ms = pick(3) == 0 ? static_cast<int64_t>(pick(20'000)) : -1;
  x.exit_code = pick(3) == 0 ? 3 : 0;
  x.stop_ms = static_cast<int64_t>(pick(4) == 0 ? 7000 : pick(500));
  x.cannot_start = pick(12) == 0;
  return x;
}

/// Some are started again, and some move when their node is lost.
void disturbance::add_policies(json& step) {
  if (pick(3) == 0)
    step["restart"] = {{"delay_s", 1}, {"max_attempts", 1 + pick(3)}};
  if (pick(3) == 0)
    step["on_node_loss"] = {{"policy", "move"}, {"after_s", 24 + pick(10)}};
}

json disturbance::some_step(size_t number) {
  const auto size = pick(4);
  auto result = work_step("s" + std::to_string(number), some_script(),
                          size == 0   ? large_deployment
                          : size == 1 ? ""
                                      : small_deployment,
                          pick(4) == 0 ? some_party().name : "");
  add_policies(result);
  return result;
}

void disturbance::request_some_task(const site_party& whom) {
  std::vector<json> steps;
  const auto count = 1 + pick(3);
  for (size_t i = 0; i < count; ++i)
    steps.push_back(some_step(i));
  place_.request(place_.add_task(whom, steps));
}

/// Many short ones on one node, more than it remembers the ends of.
void disturbance::request_burst(const site_party& whom) {
  program_script script;
  script.ends_ms = static_cast<int64_t>(pick(1000));
  std::vector<json> steps;
  const auto node = some_node().name;
  for (size_t i = 0; i < 40; ++i)
    steps.push_back(
        work_step("s" + std::to_string(i), script, tiny_deployment, node));
  place_.request(place_.add_task(whom, steps));
}

/// A new task, or one that is known is asked for or ended again.
void disturbance::operate_tasks() {
  const auto what = pick(10);
  if (what < 5 || place_.tasks.empty()) {
    const auto& whom = some_coordinator();
    if (!whom.alive())
      return;
    return pick(12) == 0 ? request_burst(whom) : request_some_task(whom);
  }
  auto& task = *place_.tasks[pick(place_.tasks.size())];
  if (!place_.parties[task.cell]->alive())
    return;
  if (what < 7)
    place_.request(task);
  else
    place_.terminate(task);
}

// -- how it ends -------------------------------------------------------------

/// For how long a registry may show a node that does not believe in it: a
/// lease, and until the next look.
disturbance::duration disturbance::longest_honest_lie() const {
  duration result = limits::lease::span + site_watch::period;
  // A frame that was held up is a sign of life when it arrives.
  if (holds_)
    result += held_for;
  // A lost frame, which TCP would repeat, costs the wait for its answer.
  if (hostile_)
    result += limits::membership::registration;
  return result;
}

std::string disturbance::broken_limits() const {
  const auto lie_limit = longest_honest_lie();
  // Coordinators that hear each other tell what has changed at once.
  const auto double_limit = hostile_ || holds_ ? lie_limit : duration{1000};
  std::string result;
  const auto check = [&](const char* what, duration known, duration limit) {
    if (known > limit)
      result +=
          std::string{what} + " for " + std::to_string(known.count()) + " ms; ";
  };
  check("a registry lied", watch_.longest_lie(), lie_limit);
  check("two registries claimed a node", watch_.longest_double(), double_limit);
  return result;
}

std::string disturbance::verdict() {
  auto result = calm_down(place_);
  result += old_registrations(place_);
  result += broken_limits();
  if (result.empty()) {
    result += release_retired(place_);
    result += end_all_tasks(place_);
  }
  for (const auto& x : place_.violations)
    result += x + "; ";
  return result;
}

} // namespace roscell::test
