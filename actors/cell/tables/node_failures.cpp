#include "actors/cell/tables/node_failures.hpp"

#include "actors/cell/limits.hpp"

#include <algorithm>

namespace roscell {

using time_point = node_failures::time_point;

namespace {

/// When it has surely ended; max(): nobody can say.
time_point surely_ended(const instance_place& x) {
  return x.silent_since && x.rule == away_rule::fenced
             ? *x.silent_since + x.after
             : time_point::max();
}

bool waits_for_its_node(const instance_place& x) {
  return x.silent_since && x.rule == away_rule::waits;
}

} // namespace

// -- where instances may run ------------------------------------------------

bool node_failures::order(instance_place x) {
  const auto known = steps_of_.find(x.instance);
  if (known == steps_of_.end() && steps_of_.size() >= limits::task::places)
    return false;
  if (known != steps_of_.end())
    erase(x.instance);
  const step_key key{x.task, x.step};
  const auto instance = x.instance;
  steps_of_[instance] = key;
  places_[key][instance] = std::move(x);
  return true;
}

bool node_failures::has_room(size_t count) const {
  return steps_of_.size() + count <= limits::task::places;
}

void node_failures::erase(const std::string& instance) {
  const auto known = steps_of_.find(instance);
  if (known == steps_of_.end())
    return;
  const auto step = places_.find(known->second);
  step->second.erase(instance);
  if (step->second.empty())
    places_.erase(step);
  steps_of_.erase(known);
}

template <class Predicate>
void node_failures::erase_if(Predicate&& is_over) {
  std::vector<std::string> over;
  for (const auto& [key, places] : places_)
    for (const auto& [instance, x] : places)
      if (is_over(x))
        over.push_back(instance);
  for (const auto& instance : over)
    erase(instance);
}

void node_failures::end(const std::string& uuid, const std::string& instance) {
  const auto known = steps_of_.find(instance);
  if (known != steps_of_.end()
      && places_.at(known->second).at(instance).uuid == uuid)
    erase(instance);
}

void node_failures::end_all(const std::string& uuid, const std::string& task,
                            const std::set<std::string>& but) {
  erase_if([&](const instance_place& x) {
    return x.uuid == uuid && x.task == task && but.count(x.instance) == 0;
  });
}

void node_failures::node_back(const std::string& uuid,
                              const std::set<std::string>& live) {
  erase_if([&](const instance_place& x) {
    return x.uuid == uuid && live.count(x.instance) == 0;
  });
  for (auto& [key, places] : places_)
    for (auto& [instance, x] : places)
      if (x.uuid == uuid)
        x.silent_since = std::nullopt;
  for (auto i = abandoned_.begin(); i != abandoned_.end();)
    i = i->second.is_alone && i->second.uuid == uuid ? abandoned_.erase(i)
                                                     : std::next(i);
}

void node_failures::node_lost(const std::string& uuid, time_point since) {
  for (auto& [key, places] : places_)
    for (auto& [instance, x] : places)
      if (x.uuid == uuid)
        x.silent_since =
            x.silent_since ? std::max(*x.silent_since, since) : since;
}

void node_failures::node_gone(const std::string& uuid, time_point now) {
  for (auto& [key, places] : places_)
    for (auto& [instance, x] : places)
      if (x.uuid == uuid && !x.silent_since)
        x.silent_since = now;
  erase_if([&](const instance_place& x) {
    return x.uuid == uuid && waits_for_its_node(x);
  });
}

void node_failures::rename_node(const std::string& uuid,
                                const std::string& name) {
  for (auto& [key, places] : places_)
    for (auto& [instance, x] : places)
      if (x.uuid == uuid)
        x.node = name;
}

void node_failures::forget_ended(time_point now) {
  erase_if([&](const instance_place& x) { return surely_ended(x) <= now; });
}

void node_failures::forget_waiting(const std::string& task) {
  erase_if([&](const instance_place& x) {
    return x.task == task && waits_for_its_node(x);
  });
}

void node_failures::forget_alone(const std::string& task) {
  erase_if([&](const instance_place& x) {
    return x.task == task && x.silent_since && x.rule == away_rule::alone;
  });
}

const instance_place* node_failures::find(const std::string& instance,
                                          time_point now) const {
  const auto known = steps_of_.find(instance);
  if (known == steps_of_.end())
    return nullptr;
  const auto& x = places_.at(known->second).at(instance);
  return surely_ended(x) <= now ? nullptr : &x;
}

std::optional<start_hold> node_failures::hold(const std::string& task,
                                              const std::string& step,
                                              time_point now,
                                              const std::string& but) const {
  std::optional<start_hold> result;
  const auto known = places_.find({task, step});
  if (known == places_.end())
    return result;
  for (const auto& [instance, x] : known->second) {
    const auto until = surely_ended(x);
    if (instance != but && until > now && (!result || result->until < until))
      result = start_hold{x, until};
  }
  return result;
}

std::optional<start_hold> node_failures::hold_of_task(const std::string& task,
                                                      time_point now) const {
  std::optional<start_hold> result;
  for (auto i = places_.lower_bound({task, ""});
       i != places_.end() && i->first.first == task; ++i)
    for (const auto& [instance, x] : i->second) {
      const auto until = surely_ended(x);
      if (!waits_for_its_node(x) && until > now
          && (!result || result->until < until))
        result = start_hold{x, until};
    }
  return result;
}

std::vector<instance_place> node_failures::places_of(const std::string& task,
                                                     time_point now) const {
  std::vector<instance_place> result;
  for (auto i = places_.lower_bound({task, ""});
       i != places_.end() && i->first.first == task; ++i)
    for (const auto& [instance, x] : i->second)
      if (surely_ended(x) > now)
        result.push_back(x);
  return result;
}

std::set<std::string> node_failures::nodes_there() const {
  std::set<std::string> result;
  for (const auto& [key, places] : places_)
    for (const auto& [instance, x] : places)
      if (!x.silent_since)
        result.insert(x.uuid);
  return result;
}

size_t node_failures::count(time_point now) const {
  size_t result = 0;
  for (const auto& [key, places] : places_)
    for (const auto& [instance, x] : places)
      result += surely_ended(x) > now ? 1 : 0;
  return result;
}

// -- steps that are to be placed anew ---------------------------------------

void node_failures::abandon(abandoned_step x) {
  if (x.is_alone)
    x.due = time_point::max();
  const auto instance = x.instance;
  abandoned_.emplace(instance, std::move(x));
}

void node_failures::forget(const std::string& instance) {
  abandoned_.erase(instance);
}

const abandoned_step*
node_failures::find_abandoned(const std::string& instance) const {
  const auto i = abandoned_.find(instance);
  return i == abandoned_.end() ? nullptr : &i->second;
}

bool node_failures::is_abandoned(const std::string& instance) const {
  const auto* x = find_abandoned(instance);
  return x && x->abandoned;
}

void node_failures::give_up(const std::string& instance) {
  if (const auto i = abandoned_.find(instance); i != abandoned_.end())
    i->second.abandoned = true;
}

void node_failures::postpone(const std::string& instance,
                             const std::string& problem, time_point now) {
  const auto i = abandoned_.find(instance);
  if (i == abandoned_.end())
    return;
  auto& x = i->second;
  x.abandoned = false;
  x.problem = problem;
  x.being_placed = false;
  x.due = now + x.pause.next();
}

void node_failures::pause(const std::string& instance, time_point until) {
  const auto i = abandoned_.find(instance);
  if (i == abandoned_.end())
    return;
  i->second.being_placed = true;
  i->second.due = until;
}

void node_failures::hurry(time_point now) {
  for (auto& [instance, x] : abandoned_)
    if (!x.problem.empty() && !x.being_placed && !x.is_alone)
      x.due = std::min(x.due, now);
}

time_point node_failures::fenced_until(const step_key& step) const {
  auto result = time_point::min();
  const auto known = places_.find(step);
  if (known != places_.end())
    for (const auto& [instance, x] : known->second)
      if (const auto until = surely_ended(x); until != time_point::max())
        result = std::max(result, until);
  return result;
}

/// No attempt is made while a fence of the step has not passed. Of a place that
/// is there the attempt itself has to say that it has ended.
time_point node_failures::due_of(const abandoned_step& x) const {
  return std::max(x.due, fenced_until({x.task, x.step}));
}

std::map<std::string, std::vector<abandoned_step>>
node_failures::due(time_point now) const {
  std::map<std::string, std::vector<abandoned_step>> result;
  for (const auto& [instance, x] : abandoned_)
    if (due_of(x) <= now)
      result[x.task].push_back(x);
  return result;
}

time_point node_failures::next_due() const {
  auto result = time_point::max();
  for (const auto& [instance, x] : abandoned_)
    result = std::min(result, due_of(x));
  return result;
}

} // namespace roscell
