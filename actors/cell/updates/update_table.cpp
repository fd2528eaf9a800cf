#include "actors/cell/updates/update_table.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

const update_table::entry* update_table::find(const std::string& task) const {
  const auto i = updates_.find(find_id(task));
  return i == updates_.end() ? nullptr : &i->second;
}

uint64_t update_table::begin(const std::string& task,
                             const std::string& request) {
  auto& x = updates_[++last_];
  x.task = task;
  x.request = request;
  return last_;
}

void update_table::plan(uint64_t id, task_update_plan plan, size_t waves) {
  const auto i = updates_.find(id);
  if (i == updates_.end())
    return;
  i->second.plan = std::move(plan);
  i->second.waves = waves;
}

bool update_table::is_updating(const std::string& task) const {
  return find(task) != nullptr;
}

uint64_t update_table::find_id(const std::string& task) const {
  for (const auto& [id, x] : updates_)
    if (x.task == task)
      return id;
  return 0;
}

const task_update_plan*
update_table::find_plan(const std::string& task,
                        const std::string& request) const {
  const auto* x = find(task);
  return x && x->plan && x->request == request ? &*x->plan : nullptr;
}

bool update_table::is_at(uint64_t id, update_stage stage) const {
  const auto i = updates_.find(id);
  return i != updates_.end() && i->second.stage == stage;
}

bool update_table::enter(uint64_t id, update_stage stage) {
  const auto i = updates_.find(id);
  if (i == updates_.end() || i->second.stage == update_stage::undone)
    return false;
  i->second.stage = stage;
  i->second.due = time_point::max();
  return true;
}

std::optional<size_t> update_table::open_wave(uint64_t id) {
  auto& x = updates_.at(id);
  if (x.opened == x.waves)
    return std::nullopt;
  x.stage = update_stage::fetching;
  return x.opened++;
}

void update_table::settle(uint64_t id, const std::set<std::string>& instances,
                          time_point until) {
  auto& x = updates_.at(id);
  x.stage = update_stage::settling;
  x.started.insert(instances.begin(), instances.end());
  x.due = until;
}

uint64_t update_table::watching(const std::string& instance) const {
  for (const auto& [id, x] : updates_)
    if (x.stage != update_stage::undone && x.started.count(instance) > 0)
      return id;
  return 0;
}

std::vector<uint64_t> update_table::take_settled(time_point now) {
  std::vector<uint64_t> result;
  for (auto& [id, x] : updates_)
    if (x.due <= now) {
      x.due = time_point::max();
      result.push_back(id);
    }
  return result;
}

update_table::time_point update_table::next_due() const {
  auto result = time_point::max();
  for (const auto& [id, x] : updates_)
    result = std::min(result, x.due);
  return result;
}

void update_table::end(uint64_t id) {
  updates_.erase(id);
}

std::string update_table::text(const std::string& task) const {
  const auto* x = find(task);
  if (!x)
    return {};
  const auto part =
      std::to_string(x->opened) + " of " + std::to_string(x->waves);
  switch (x->stage) {
  case update_stage::planned:
    return "its change is being placed";
  case update_stage::fetching:
    return "part " + part + ": its builds are fetched";
  case update_stage::ending:
    return "part " + part + ": what is replaced ends";
  case update_stage::starting:
    return "part " + part + ": what is new starts";
  case update_stage::settling:
    return "part " + part + ": what is new is to run well for a while";
  case update_stage::written:
    return "its new request is being written down";
  case update_stage::undone:
    return "what was replaced is put back";
  }
  return {};
}

} // namespace roscell
