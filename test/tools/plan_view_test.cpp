#include "tools/roscell/view/plan_view.hpp"

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
           "score 0.125 = balance 0.1 + 0.1 * load 0.25\n"
           "columns CPU to GPU MEMORY: fraction of what was free\n"
           "\n"
           "STEP   NODE   DEPLOYMENT  REJECTED BECAUSE\n"
           "poses  arm-1  gpu         no GPU; memory short by 5\n");
}

TEST_CASE("a plan that is not proven optimal says so", "[tools]") {
  auto plan = sample();
  plan.optimal = false;
  plan.score.lower_bound = 0.12;
  plan.score.gap = 0.005;
  plan.warnings = {"node 'b' uses more than it has"};
  const auto text = plan_view(plan, {});
  CHECK(text.find("best found, not proven optimal: no total is below 0.12, "
                  "a gap of 0.005\n")
        != text.npos);
  CHECK(text.find("warning: node 'b' uses more than it has\n") != text.npos);
}

TEST_CASE("a plan without rejections says so in words", "[tools]") {
  CHECK(rejected_view({}, {}) == "no rejected candidates\n");
}

TEST_CASE("a plan shows each resource before and after as a bar", "[tools]") {
  auto plan = sample();
  plan.use = {{"arm-1", "cpu", 4, 1, 3},
              {"arm-1", "memory", 1000, 1200, 1300},
              {"arm-1", "gpu_0", 0, 0, 0}};
  const auto text = plan_view(plan, {});
  CHECK(
      text.find("arm-1  cpu       [#####++++++++++.....]       1      3     4 "
                "    25%    75%\n")
      != text.npos);
  CHECK(
      text.find("[####################]    1200   1300  1000    120%   130%\n")
      != text.npos);
  CHECK(text.find("[....................]") != text.npos);
  CHECK(text.find("USE: # before, + with this task\n") != text.npos);
}

TEST_CASE("a plan shows what the best alternative of a step costs", "[tools]") {
  auto plan = sample();
  auto others = plan.allocations;
  others[1].node = "gpu-2";
  plan.alternatives = {{"poses", true, 0.5, "", {0.625, 0.5, 1.25}, others}};
  auto text = plan_view(plan, {});
  CHECK(text.find("why: the best alternative for step 'poses' costs 0.5 more: "
                  "0.625 = balance 0.5 + 0.1 * load 1.25\n\nSTEP ")
        != text.npos);
  CHECK(text.find("poses  gpu-2  gpu") != text.npos);
  plan.alternatives[0].obstacle = "step 'poses' fits on no node";
  text = plan_view(plan, {});
  CHECK(text.find("why: step 'poses' can be nowhere else: step 'poses' fits on "
                  "no node\n")
        != text.npos);
}
