#include "builders.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace roscell::allocation;
using namespace roscell::allocation::test;
using Catch::Matchers::Contains;

namespace {

/// A node that could run the step below but for what a test changes.
problem one_of_each() {
  problem asked;
  asked.nodes = {make_node("a", 1.5, 300, 400)};
  add_step(asked, "poses", {make_cpu(1, 200, 100)});
  return asked;
}

/// The only rejected candidate's only reason.
reason only_reason(const problem& asked) {
  auto answer = allocate(asked);
  REQUIRE(answer.what == outcome::infeasible);
  REQUIRE(answer.rejected.size() == 1);
  REQUIRE(answer.rejected[0].reasons.size() == 1);
  return answer.rejected[0].reasons[0];
}

deployment& way(problem& asked) {
  return asked.steps[0].deployments[0];
}

} // namespace

TEST_CASE("a shortage of CPU is told in cores") {
  auto asked = one_of_each();
  way(asked).cpu = 2;
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::cpu);
  CHECK(why.text == "needs 2.0 cores, 1.5 free: short by 0.5");
  CHECK(why.needed == 2);
  CHECK(why.free == 1.5);
  CHECK(why.short_by == 0.5);
}

TEST_CASE("a node without a secret of a step is none for it, and what sets it "
          "is told") {
  auto asked = one_of_each();
  asked.steps[0].secrets = {"key", "pass"};
  asked.nodes[0].secrets = {"other", "pass"};
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::secret);
  CHECK(std::string{to_string(why.kind)} == "excluded");
  CHECK(why.text
        == "needs the secret 'key', the node does not have it: `roscell secret "
           "set key` there");
  asked.nodes[0].secrets.push_back("key");
  CHECK(allocate(asked).optimal());
}

TEST_CASE("a shortage of memory is told in MiB") {
  auto asked = one_of_each();
  asked.nodes[0].memory_mib.used = 150;
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::memory);
  CHECK(why.text == "needs 200 MiB of memory, 150 free: short by 50");
}

TEST_CASE("a shortage of disk is told in MiB") {
  auto asked = one_of_each();
  way(asked).disk_mib = 400.5;
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::disk);
  CHECK(why.text == "needs 400.5 MiB of disk, 400 free: short by 0.5");
}

TEST_CASE("a shortage of GPU memory is told for each GPU") {
  auto asked = one_of_each();
  way(asked) = make_gpu(1, 200, 100, 900);
  asked.nodes[0] = with_gpu(asked.nodes[0], 4, 800);
  asked.nodes[0] = with_gpu(asked.nodes[0], 1, 500);
  auto answer = allocate(asked);
  REQUIRE(answer.rejected.size() == 2);
  CHECK(answer.rejected[0].gpu == 1);
  CHECK(answer.rejected[0].reasons[0].kind == reason_kind::gpu_memory);
  CHECK(answer.rejected[0].reasons[0].text
        == "needs 900 MiB of GPU memory, 500 free: short by 400");
  CHECK(answer.rejected[1].gpu == 4);
  CHECK(answer.rejected[1].reasons[0].short_by == 100);
}

TEST_CASE("a shortage of unified memory is told for both requests together") {
  auto asked = one_of_each();
  asked.nodes[0] = unified(asked.nodes[0]);
  way(asked) = make_gpu(1, 200, 100, 150);
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::memory);
  CHECK(why.text
        == "needs 200 MiB of memory and 150 MiB of GPU memory out of one "
           "pool, 300 free: short by 50");
}

TEST_CASE("a node without a GPU is told apart from a GPU without room") {
  auto asked = one_of_each();
  way(asked) = make_gpu(1, 200, 100, 0);
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::gpu);
  CHECK(why.text == "needs a GPU, the node has none");
  // Unified memory alone does not make a GPU.
  asked.nodes[0].unified_memory = true;
  CHECK(only_reason(asked).kind == reason_kind::gpu);
}

TEST_CASE("an architecture that does not match is named") {
  auto asked = one_of_each();
  way(asked).architectures = {"arm64", "riscv64"};
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::architecture);
  CHECK(why.text == "runs on arm64 and riscv64, the node is 'amd64'");
  way(asked).architectures.emplace_back("amd64");
  CHECK(allocate(asked).optimal());
}

TEST_CASE("a missing device is named") {
  auto asked = one_of_each();
  way(asked).devices = {"/dev/video0"};
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::device);
  CHECK(why.text
        == "needs the device '/dev/video0', the node does not have it");
  asked.nodes[0].devices = {"/dev/video0"};
  CHECK(allocate(asked).optimal());
}

TEST_CASE("a missing or different label of step or deployment is named") {
  auto asked = one_of_each();
  asked.steps[0].labels["room"] = "lab";
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::label);
  CHECK(why.text == "needs the label 'room=lab', the node has no label 'room'");
  asked.nodes[0].labels["room"] = "hall";
  CHECK(only_reason(asked).text
        == "needs the label 'room=lab', the node has 'room=hall'");
  asked.nodes[0].labels["room"] = "lab";
  CHECK(allocate(asked).optimal());
  way(asked).labels["arm"] = "yes";
  CHECK(only_reason(asked).kind == reason_kind::label);
}

TEST_CASE("a node without the skill is told") {
  auto asked = one_of_each();
  asked.steps[0].nodes_with_skill = {"somewhere-else"};
  auto why = only_reason(asked);
  CHECK(why.kind == reason_kind::skill);
  CHECK(why.text == "the node does not have the skill");
}

TEST_CASE("a node without CPU or memory capacity hosts nothing") {
  auto asked = one_of_each();
  way(asked) = make_cpu(0, 0, 0);
  asked.nodes[0].cpu = {};
  CHECK(only_reason(asked).text == "the node offers no CPU");
  asked.nodes[0].cpu.capacity = 1;
  asked.nodes[0].memory_mib = {};
  CHECK(only_reason(asked).text == "the node offers no memory");
}

TEST_CASE("every reason against a candidate is told, not only the first") {
  auto asked = one_of_each();
  way(asked) = make_gpu(2, 400, 500, 100);
  way(asked).architectures = {"arm64"};
  way(asked).devices = {"/dev/video0"};
  way(asked).labels["arm"] = "yes";
  asked.steps[0].nodes_with_skill.clear();
  auto answer = allocate(asked);
  REQUIRE(answer.rejected.size() == 1);
  std::vector<std::string> kinds;
  for (const auto& why : answer.rejected[0].reasons)
    kinds.emplace_back(to_string(why.kind));
  CHECK(kinds
        == std::vector<std::string>{"skill", "architecture", "label", "device",
                                    "gpu", "cpu", "memory", "disk"});
}

TEST_CASE("a feasible answer tells the candidates that cannot be used") {
  auto asked = one_of_each();
  asked.nodes.push_back(make_node("tiny", 0.125, 300, 400));
  asked.steps[0].nodes_with_skill.insert("tiny");
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  REQUIRE(answer.rejected.size() == 1);
  CHECK(answer.rejected[0].step == 0);
  CHECK(answer.rejected[0].node == 1);
  CHECK(answer.rejected[0].deployment == 0);
  CHECK(answer.rejected[0].reasons[0].text
        == "needs 1.0 cores, 0.125 free: short by 0.875");
}

TEST_CASE("a step that fits nowhere is named, also to the other steps") {
  auto asked = one_of_each();
  add_step(asked, "big", {make_cpu(9, 0, 0)});
  auto answer = allocate(asked);
  REQUIRE(answer.what == outcome::infeasible);
  CHECK(answer.conflict == std::vector<std::size_t>{1});
  CHECK(answer.message == "step 'big' fits on no node");
  REQUIRE(answer.rejected.size() == 2);
  CHECK(answer.rejected[0].step == 1);
  CHECK(answer.rejected[0].reasons[0].kind == reason_kind::cpu);
  CHECK(answer.rejected[1].step == 0);
  CHECK(answer.rejected[1].reasons[0].kind == reason_kind::combination);
  CHECK(answer.rejected[1].reasons[0].text
        == "fits alone, but step 'big' fits on no node");
}

TEST_CASE("a step without any deployment option is told") {
  auto asked = one_of_each();
  way(asked).cpu = 1;
  asked.steps[0].deployments.clear();
  auto answer = allocate(asked);
  CHECK(answer.what == outcome::infeasible);
  CHECK(answer.message
        == "step 'poses' has no deployment option to choose "
           "from");
}

TEST_CASE("a cell without nodes is told") {
  auto asked = one_of_each();
  asked.nodes.clear();
  auto answer = allocate(asked);
  CHECK(answer.what == outcome::infeasible);
  CHECK(answer.message == "there is no node");
  CHECK(std::isinf(answer.lower_bound));
}

TEST_CASE("steps that only fit without each other are told with the amounts") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000), make_node("b", 8, 50, 1000)};
  add_step(asked, "camera", {make_cpu(1, 20, 0)});
  add_step(asked, "poses", {make_cpu(3, 600, 0)});
  add_step(asked, "map", {make_cpu(2, 500, 0)});
  asked.steps[2].labels["room"] = "lab";
  asked.nodes[0].labels["room"] = "lab";
  auto answer = allocate(asked);
  REQUIRE(answer.what == outcome::infeasible);
  CHECK(answer.conflict == std::vector<std::size_t>{1, 2});
  CHECK(answer.message == "steps 'poses' and 'map' cannot be placed together");
  // poses and map on b are short alone; the other four fit alone.
  REQUIRE(answer.rejected.size() == 6);
  const auto& camera = answer.rejected[2];
  CHECK(camera.step == 0);
  REQUIRE(camera.reasons.size() == 1);
  CHECK(camera.reasons[0].text
        == "fits alone, but steps 'poses' and 'map' cannot be placed "
           "together");
  const auto& poses = answer.rejected[4];
  CHECK(poses.step == 1);
  REQUIRE(poses.reasons.size() == 2);
  CHECK(poses.reasons[0].kind == reason_kind::combination);
  CHECK(poses.reasons[0].text
        == "fits alone, but steps 'poses' and 'map' cannot be placed "
           "together; with step 'map' this node needs 5.0 cores, 4.0 free: "
           "short by 1.0");
  CHECK(poses.reasons[0].short_by == 1);
  CHECK_THAT(poses.reasons[1].text,
             Contains("needs 1100 MiB of memory, 1000 free: short by 100"));
}

TEST_CASE("a conflict on a GPU is told in its memory") {
  problem asked;
  asked.nodes = {with_gpu(make_node("a", 8, 8000, 8000), 0, 1000)};
  add_step(asked, "detect", {make_gpu(1, 100, 100, 700)});
  add_step(asked, "track", {make_gpu(1, 100, 100, 600)});
  auto answer = allocate(asked);
  REQUIRE(answer.rejected.size() == 2);
  for (const auto& one : answer.rejected) {
    REQUIRE(one.reasons.size() == 1);
    CHECK_THAT(one.reasons[0].text,
               Contains("needs 1300 MiB of GPU memory, 1000 free: short by "
                        "300"));
  }
}

TEST_CASE("a conflict in unified memory counts GPU memory as memory") {
  problem asked;
  asked.nodes = {unified(make_node("jetson", 8, 1000, 8000))};
  add_step(asked, "detect", {make_gpu(1, 100, 100, 600)});
  add_step(asked, "filter", {make_cpu(1, 400, 100)});
  auto answer = allocate(asked);
  REQUIRE(answer.rejected.size() == 2);
  for (const auto& one : answer.rejected)
    CHECK_THAT(one.reasons[0].text,
               Contains("needs 1100 MiB of memory, 1000 free: short by 100"));
}

TEST_CASE("a rival counts with the deployment that needs least") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000)};
  auto large = make_cpu(4, 10, 10);
  large.name = "cpu-large";
  add_step(asked, "poses", {make_cpu(3, 10, 10)});
  add_step(asked, "map", {make_cpu(2, 10, 10), large});
  auto answer = allocate(asked);
  REQUIRE(answer.rejected.size() == 3);
  CHECK_THAT(answer.rejected[0].reasons[0].text,
             Contains("needs 5.0 cores, 4.0 free: short by 1.0"));
}

TEST_CASE("many equal steps that do not fit are refused quickly") {
  problem asked;
  for (int v = 0; v < 12; ++v)
    asked.nodes.push_back(
        make_node("node-" + std::to_string(v), 2.9, 1000, 1000));
  for (int i = 0; i < 25; ++i)
    add_step(asked, "step-" + std::to_string(i), {make_cpu(1, 10, 10)});
  limits bounds;
  int left = 2'000'000;
  bounds.cancelled = [&left] { return left-- <= 0; };
  auto answer = allocate(asked, bounds);
  CHECK(answer.what == outcome::infeasible);
  CHECK(answer.conflict.size() == 25);
}

TEST_CASE("a greedy start that fails does not hide an allocation that fits") {
  problem asked;
  // Fractions 1/2, 1/2, 1/2 draw the first step to the second node, where
  // the second step must go.
  asked.nodes = {make_node("a", 2, 400, 1000), make_node("b", 2, 200, 200)};
  add_step(asked, "first", {make_cpu(1, 100, 100)});
  add_step(asked, "second", {make_cpu(2, 100, 100)});
  asked.steps[1].nodes_with_skill = {"b"};
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(chosen(answer) == choices{{0, 0, -1}, {1, 0, -1}});
}
