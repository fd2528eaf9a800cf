#include "actors/placement/search/report/validate.hpp"

#include "builders.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <limits>

using namespace roscell::allocation;
using namespace roscell::allocation::test;
using Catch::Matchers::StartsWith;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

problem good() {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000),
                 with_gpu(make_node("b", 4, 1000, 1000), 0, 500)};
  add_step(asked, "first", {make_cpu(1, 100, 100)});
  add_step(asked, "second",
           {make_cpu(1, 100, 100), make_gpu(1, 100, 100, 100)});
  return asked;
}

/// What is said about a good problem with one change, which must be refused.
std::string refusal(const std::function<void(problem&)>& change) {
  auto asked = good();
  change(asked);
  auto answer = allocate(asked);
  REQUIRE(answer.what == outcome::invalid);
  REQUIRE(answer.message == validate(asked));
  REQUIRE(answer.placements.empty());
  return answer.message;
}

} // namespace

TEST_CASE("a good problem is taken") {
  CHECK_FALSE(validate(good()));
  CHECK(allocate(good()).optimal());
}

TEST_CASE("a bad amount of a node is refused by its place") {
  for (double bad : {-1.0, nan_value, infinity, -infinity, 1e13}) {
    CHECK_THAT(refusal([&](problem& p) { p.nodes[1].cpu.capacity = bad; }),
               StartsWith("nodes[1].cpu.capacity is "));
    CHECK_THAT(refusal([&](problem& p) { p.nodes[0].cpu.used = bad; }),
               StartsWith("nodes[0].cpu.used is "));
    CHECK_THAT(
        refusal([&](problem& p) { p.nodes[0].memory_mib.capacity = bad; }),
        StartsWith("nodes[0].memory_mib.capacity is "));
    CHECK_THAT(refusal([&](problem& p) { p.nodes[0].disk_mib.used = bad; }),
               StartsWith("nodes[0].disk_mib.used is "));
    CHECK_THAT(refusal([&](problem& p) {
                 p.nodes[1].gpus[0].memory_mib.capacity = bad;
               }),
               StartsWith("nodes[1].gpus[0].memory_mib.capacity is "));
  }
  CHECK(refusal([](problem& p) { p.nodes[1].cpu.capacity = -1; })
        == "nodes[1].cpu.capacity is -1, not a number from 0 to 1e+12");
}

TEST_CASE("a bad request of a deployment is refused by its place") {
  for (double bad : {-0.5, nan_value, infinity, 1e13}) {
    auto change = [&](double deployment::*member) {
      return refusal(
          [&](problem& p) { p.steps[1].deployments[1].*member = bad; });
    };
    CHECK_THAT(change(&deployment::cpu),
               StartsWith("steps[1].deployments[1].cpu is "));
    CHECK_THAT(change(&deployment::memory_mib),
               StartsWith("steps[1].deployments[1].memory_mib is "));
    CHECK_THAT(change(&deployment::disk_mib),
               StartsWith("steps[1].deployments[1].disk_mib is "));
    CHECK_THAT(change(&deployment::gpu_memory_mib),
               StartsWith("steps[1].deployments[1].gpu_memory_mib is "));
  }
}

TEST_CASE("GPU memory without a GPU is refused") {
  CHECK(
      refusal([](problem& p) { p.steps[0].deployments[0].gpu_memory_mib = 1; })
      == "steps[0].deployments[0].gpu_memory_mib is above 0 without a need "
         "for a GPU");
}

TEST_CASE("bad weights are refused") {
  CHECK_THAT(refusal([](problem& p) { p.alpha = -0.1; }),
             StartsWith("alpha is -0.1, not a number from 0 to "));
  CHECK_THAT(refusal([](problem& p) { p.alpha = nan_value; }),
             StartsWith("alpha is "));
  CHECK_THAT(refusal([](problem& p) { p.gpu_bonus = infinity; }),
             StartsWith("gpu_bonus is inf"));
}

TEST_CASE("names must be there and different") {
  CHECK(refusal([](problem& p) { p.nodes[1].name = "a"; })
        == "nodes[1].name 'a' is given twice");
  CHECK(refusal([](problem& p) { p.nodes[0].name = ""; })
        == "nodes[0].name is empty");
  CHECK(refusal([](problem& p) { p.steps[1].id = "first"; })
        == "steps[1].id 'first' is given twice");
  CHECK(refusal([](problem& p) { p.steps[0].id = ""; })
        == "steps[0].id is empty");
  CHECK(refusal([](problem& p) { p.steps[1].deployments[1].name = "cpu"; })
        == "steps[1].deployments[1].name 'cpu' is given twice");
}

TEST_CASE("GPU indices must be different and not negative") {
  CHECK(refusal([](problem& p) {
          p.nodes[1].gpus.push_back({0, {}});
        })
        == "nodes[1].gpus[1].index 0 is given twice");
  CHECK(refusal([](problem& p) { p.nodes[1].gpus[0].index = -1; })
        == "nodes[1].gpus[0].index is -1, not 0 or more");
}

TEST_CASE("a request without steps is refused") {
  CHECK(refusal([](problem& p) { p.steps.clear(); }) == "steps is empty");
}

TEST_CASE("a problem that is too large is refused") {
  CHECK(refusal([](problem& p) { p.steps.assign(max_steps + 1, p.steps[0]); })
        == "steps: 129 are given, the most is 128");
  CHECK_THAT(
      refusal([](problem& p) { p.nodes.assign(max_candidates, p.nodes[0]); }),
      StartsWith("steps and nodes: they make up to "));
}
