#include "tools/roscell/plan_view.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

task_plan sample() {
  task_plan plan;
  plan.task = "fleet-poses";
  plan.score = {0.125, 0.1, 0.25};
  plan.allocations = {
      {"camera", "arm-1", "cpu", -1, {0.25, 0.1, 0, -1}, 0.010833, 0},
      {"poses", "gpu-1", "gpu", 0, {0.5, 1.0 / 3, 0, 0.125}, 0.035, -0.01}};
  plan.rejected = {{"poses", "arm-1", "gpu", {"no GPU", "memory short by 5"}}};
  return plan;
}

} // namespace

TEST_CASE("a plan shows steps, score and rejected candidates", "[tools]") {
  CHECK(plan_view(sample(), {})
        == "task fleet-poses, optimal\n"
           "\n"
           "STEP    NODE   DEPLOYMENT  GPU   CPU  MEMORY  DISK  GPU MEMORY  "
           "VARIANCE  BONUS\n"
           "camera  arm-1  cpu           -  0.25     0.1     0           -  "
           "0.010833      0\n"
           "poses   gpu-1  gpu           0   0.5  0.3333     0       0.125  "
           "   0.035  -0.01\n"
           "\n"
           "score 0.125 = balance 0.1 + alpha * load 0.25\n"
           "columns CPU to GPU MEMORY: fraction of what was free\n"
           "\n"
           "STEP   NODE   DEPLOYMENT  REJECTED BECAUSE\n"
           "poses  arm-1  gpu         no GPU; memory short by 5\n");
}

TEST_CASE("a plan that is not proven optimal says so", "[tools]") {
  auto plan = sample();
  plan.optimal = false;
  plan.warnings = {"node 'b' uses more than it has"};
  const auto text = plan_view(plan, {});
  CHECK(text.find("best found, not proven optimal") != text.npos);
  CHECK(text.find("warning: node 'b' uses more than it has\n") != text.npos);
}

TEST_CASE("a plan without rejections says so in words", "[tools]") {
  CHECK(rejected_view({}, {}) == "no rejected candidates\n");
}
