#include "actors/placement/search/report/explain.hpp"

#include "builders.hpp"
#include "random_cases.hpp"

#include <catch2/catch.hpp>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

bool takes(const result& answer, const exclusion& one) {
  const auto& made = answer.placements[one.step];
  return made.node == one.node && made.deployment == one.deployment
         && made.gpu == one.gpu;
}

} // namespace

TEST_CASE("an excluded candidate is rejected for its reason") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000), make_node("b", 2, 400, 500)};
  add_step(asked, "only", {make_cpu(1, 100, 50)});
  auto before = allocate(asked);
  const auto& first = before.placements.at(0);
  asked.excluded = {{0, first.node, 0, -1, "refused by the node: too busy"}};
  auto after = allocate(asked);
  REQUIRE(after.optimal());
  CHECK(after.placements[0].node != first.node);
  REQUIRE(after.rejected.size() == 1);
  CHECK(after.rejected[0].reasons[0].kind == reason_kind::excluded);
  CHECK(after.rejected[0].reasons[0].text == "refused by the node: too busy");
  asked.excluded.push_back({0, 1 - first.node, 0, -1, "no"});
  CHECK(allocate(asked).what == outcome::infeasible);
}

TEST_CASE("an exclusion names one GPU and leaves the others") {
  problem asked;
  asked.nodes = {
      with_gpu(with_gpu(make_node("g", 4, 1000, 1000), 3, 800), 5, 800)};
  add_step(asked, "only", {make_gpu(1, 100, 50, 100)});
  CHECK(allocate(asked).placements.at(0).gpu == 3);
  asked.excluded = {{0, 0, 0, 3, "no"}};
  CHECK(allocate(asked).placements.at(0).gpu == 5);
}

TEST_CASE("one of several equal nodes can be excluded") {
  problem asked;
  for (int v = 0; v < 5; ++v)
    asked.nodes.push_back(make_node("n" + std::to_string(v), 4, 1000, 1000));
  add_step(asked, "only", {make_cpu(1, 100, 50)});
  asked.excluded = {{0, 0, 0, -1, "no"}, {0, 2, 0, -1, "no"}};
  CHECK(allocate(asked).placements.at(0).node == 1);
}

TEST_CASE("the alternative is the best that places the step otherwise") {
  int compared = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    INFO("seed " << seed);
    auto asked = translated(random_instance(seed));
    auto best = allocate(asked);
    if (!best.optimal())
      continue;
    auto step = seed % asked.steps.size();
    auto other = alternative(asked, best, step);
    if (!other.has_allocation()) {
      CHECK(other.what == outcome::infeasible);
      continue;
    }
    ++compared;
    const auto& taken = best.placements[step];
    CHECK(other.value.total >= best.value.total - 1e-12);
    CHECK_FALSE(
        takes(other, {step, taken.node, taken.deployment, taken.gpu, ""}));
    // Nothing better is hidden behind it: with what it chose excluded too,
    // the total does not fall.
    const auto& next = other.placements[step];
    asked.excluded = {{step, taken.node, taken.deployment, taken.gpu, "no"},
                      {step, next.node, next.deployment, next.gpu, "no"}};
    auto third = allocate(asked);
    if (third.has_allocation())
      CHECK(third.value.total >= other.value.total - 1e-12);
  }
  CHECK(compared > 100);
}

TEST_CASE("uses are those of the nodes that host a step") {
  problem asked;
  asked.nodes = {make_node("idle", 0, 0, 0),
                 with_gpu(make_node("g", 4, 1000, 1000), 2, 800),
                 unified(make_node("u", 4, 1000, 1000))};
  asked.nodes[1].cpu.used = 1;
  add_step(asked, "on-gpu", {make_gpu(1, 100, 50, 200)});
  add_step(asked, "on-pool", {make_gpu(1, 100, 50, 200)});
  asked.steps[0].nodes_with_skill = {"g"};
  asked.steps[1].nodes_with_skill = {"u"};
  auto all = uses(asked, allocate(asked).placements);
  REQUIRE(all.size() == 4 + 3);
  CHECK(all[0].name == "cpu");
  CHECK(all[0].before == 1);
  CHECK(all[0].after == 2);
  CHECK(all[3].name == "gpu_2");
  CHECK(all[3].capacity == 800);
  CHECK(all[3].after == 200);
  CHECK(all[5].name == "memory");
  CHECK(all[5].node == 2);
  CHECK(all[5].after == 300);
}
