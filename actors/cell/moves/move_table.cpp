#include "actors/cell/moves/move_table.hpp"

#include "actors/core/answer_limits.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace roscell {

namespace {

using group = std::pair<std::string, uint64_t>;

/// What shares files with a step that ends first is with it all the time.
void end_together(std::vector<moving_step>& steps) {
  std::set<group> first;
  for (const auto& x : steps)
    if (x.ends_first && x.together > 0)
      first.insert({x.task, x.together});
  for (auto& x : steps)
    x.ends_first = x.ends_first || first.count({x.task, x.together}) > 0;
}

/// Numbers the waves from 1 on, without gaps, and gives the last one.
size_t number_waves(std::vector<moving_step>& steps) {
  size_t last = 0;
  std::map<group, size_t> waves;
  if (std::any_of(steps.begin(), steps.end(),
                  [](const auto& x) { return !x.ends_first; }))
    last = 1;
  for (auto& x : steps) {
    if (!x.ends_first) {
      x.wave = 1;
      continue;
    }
    const auto known = waves.find({x.task, x.together});
    if (x.together > 0 && known != waves.end()) {
      x.wave = known->second;
      continue;
    }
    x.wave = ++last;
    if (x.together > 0)
      waves[{x.task, x.together}] = x.wave;
  }
  return last;
}

bool is_over(move_stage x) {
  return x >= move_stage::moved;
}

std::string step_progress_text(const moving_step& x) {
  const auto what = "'" + x.task + "/" + x.step + "'";
  if (x.stage == move_stage::ending)
    return what + " on node '" + x.node + "' to be stop-safe and to end";
  if (x.stage == move_stage::starting)
    return what + " to run on its new node";
  return "";
}

} // namespace

uint64_t move_table::begin(std::vector<moving_step> steps, bool in_waves) {
  move x;
  x.steps = std::move(steps);
  if (in_waves) {
    end_together(x.steps);
    x.waves = number_waves(x.steps);
  } else {
    for (auto& step : x.steps)
      step.wave = 1;
    x.waves = 1;
  }
  moves_[++last_] = std::move(x);
  return last_;
}

std::vector<size_t> move_table::open_wave(uint64_t id) {
  const auto i = moves_.find(id);
  if (i == moves_.end())
    return {};
  auto& x = i->second;
  while (x.wave < x.waves) {
    ++x.wave;
    auto result = in_wave(id, move_stage::placed);
    if (!result.empty())
      return result;
  }
  return {};
}

std::vector<size_t> move_table::in_wave(uint64_t id, move_stage stage) const {
  std::vector<size_t> result;
  const auto i = moves_.find(id);
  if (i != moves_.end())
    for (size_t k = 0; k < i->second.steps.size(); ++k)
      if (i->second.steps[k].wave == i->second.wave
          && i->second.steps[k].stage == stage)
        result.push_back(k);
  return result;
}

std::vector<size_t> move_table::at(uint64_t id, move_stage stage) const {
  std::vector<size_t> result;
  const auto i = moves_.find(id);
  if (i != moves_.end())
    for (size_t k = 0; k < i->second.steps.size(); ++k)
      if (i->second.steps[k].stage == stage)
        result.push_back(k);
  return result;
}

const moving_step* move_table::find(uint64_t id, size_t step) const {
  const auto i = moves_.find(id);
  return i != moves_.end() && step < i->second.steps.size()
             ? &i->second.steps[step]
             : nullptr;
}

bool move_table::enter(uint64_t id, size_t step, move_stage stage,
                       time_point now) {
  const auto* known = find(id, step);
  if (!known || is_over(known->stage))
    return false;
  auto& x = moves_.at(id).steps[step];
  x.stage = stage;
  if (stage == move_stage::ordered)
    x.deadline = now + limits::task::eviction;
  else if (stage == move_stage::starting)
    x.deadline = now + limits::task::deployment;
  return true;
}

bool move_table::is_at(uint64_t id, size_t step, move_stage stage) const {
  const auto* x = find(id, step);
  return x && x->stage == stage;
}

bool move_table::ends_first(uint64_t id, size_t step) const {
  const auto* x = find(id, step);
  return x && x->ends_first;
}

move_table::time_point move_table::deadline_of(uint64_t id, size_t step) const {
  const auto* x = find(id, step);
  return x ? x->deadline : time_point::max();
}

std::string move_table::waits_on(const std::string& node) const {
  for (const auto& [id, x] : moves_)
    for (const auto& step : x.steps)
      if (step.node == node)
        if (auto text = step_progress_text(step); !text.empty())
          return text;
  return "";
}

void move_table::end(uint64_t id) {
  moves_.erase(id);
}

rebalance_move* rebalance_table::current() {
  return report_.running && next_ > 0 ? &report_.moves[next_ - 1] : nullptr;
}

void rebalance_table::begin(cell_rebalanced plan, bool force) {
  report_ = std::move(plan);
  report_.running = true;
  force_ = force;
  stopped_ = false;
  next_ = 0;
}

const rebalance_move* rebalance_table::begin_next() {
  if (stopped_ || next_ == report_.moves.size()) {
    if (stopped_ && next_ < report_.moves.size())
      report_.problem = "it was stopped";
    end();
    return nullptr;
  }
  auto& result = report_.moves[next_++];
  result.state = move_state::moving;
  return &result;
}

void rebalance_table::settle(const std::string& instance, time_point until) {
  if (auto* x = current()) {
    x->state = move_state::settling;
    settling_ = instance;
    due_ = until;
  }
}

void rebalance_table::complete() {
  if (auto* x = current())
    x->state = move_state::done;
  settling_.clear();
  due_ = time_point::max();
}

void rebalance_table::fail(const std::string& problem) {
  if (auto* x = current())
    x->state = move_state::failed;
  report_.problem = problem;
  end();
}

void rebalance_table::stop() {
  stopped_ = true;
}

void rebalance_table::end() {
  report_.running = false;
  settling_.clear();
  due_ = time_point::max();
}

} // namespace roscell
