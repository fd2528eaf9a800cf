#include "actors/placement/search/assignment.hpp"

namespace roscell::allocation {

namespace {

placement describe(const search_space& space, std::size_t step,
                   const candidate& choice, const shares& all) {
  placement made;
  made.step = step;
  made.node = choice.node;
  made.deployment = choice.deployment;
  if (choice.gpu >= 0)
    made.gpu = space.asked.nodes[choice.node].gpus[choice.gpu].index;
  made.shares.cpu = all.of[cpu].fraction();
  made.shares.memory = all.of[memory].fraction();
  made.shares.disk = all.of[disk].fraction();
  if (all.count > gpu_memory)
    made.shares.gpu_memory = all.of[gpu_memory].fraction();
  made.variance = all.variance();
  made.bonus = space.way(step, choice).needs_gpu ? space.asked.gpu_bonus : 0;
  return made;
}

} // namespace

score score_of(const search_space& space, double sum, const occupancy& now) {
  score value;
  value.balance = sum / static_cast<double>(space.steps());
  value.load = now.load_variance();
  value.total = value.balance + space.asked.alpha * value.load;
  return value;
}

std::optional<score> evaluate(const search_space& space,
                              const assignment& chosen, occupancy& scratch) {
  std::vector<occupancy::saved> before;
  double sum = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto& choice = space.choice(i, chosen[i]);
    auto all = scratch.shares_of(space.way(i, choice), choice);
    if (!all.fit() || space.is_apart(i, choice, chosen))
      break;
    sum += space.cost(i, choice, all);
    before.push_back(scratch.place(space.way(i, choice), choice));
  }
  std::optional<score> value;
  if (before.size() == chosen.size())
    value = score_of(space, sum, scratch);
  for (auto i = before.size(); i-- > 0;)
    scratch.restore(space.choice(i, chosen[i]), before[i]);
  return value;
}

std::vector<placement> placements(const search_space& space,
                                  const assignment& chosen) {
  auto now = space.empty;
  std::vector<placement> made;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto& choice = space.choice(i, chosen[i]);
    const auto& way = space.way(i, choice);
    made.push_back(describe(space, i, choice, now.shares_of(way, choice)));
    now.place(way, choice);
  }
  return made;
}

} // namespace roscell::allocation
