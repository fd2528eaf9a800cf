#include "builders.hpp"

#include <catch2/catch.hpp>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

TEST_CASE("among equal nodes the first one is taken") {
  problem asked;
  for (const char* name : {"c", "a", "b"})
    asked.nodes.push_back(make_node(name, 4, 400, 400));
  add_step(asked, "poses", {make_cpu(1, 100, 100)});
  CHECK(chosen(allocate(asked)) == choices{{0, 0, -1}});
}

TEST_CASE("a better node goes before an earlier one") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 800), make_node("b", 4, 400, 400)};
  add_step(asked, "poses", {make_cpu(1, 100, 100)});
  CHECK(chosen(allocate(asked)) == choices{{1, 0, -1}});
}

TEST_CASE("on the same node the earlier deployment is taken") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 400)};
  auto other = make_cpu(2, 200, 200);
  other.name = "cpu-large";
  // All fractions of either are equal, so both have variance 0.
  add_step(asked, "poses", {make_cpu(1, 100, 100), other});
  CHECK(chosen(allocate(asked)) == choices{{0, 0, -1}});
  std::swap(asked.steps[0].deployments[0], asked.steps[0].deployments[1]);
  CHECK(chosen(allocate(asked)) == choices{{0, 0, -1}});
}

TEST_CASE("nodes go before deployments in the tie rule") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 400), make_node("b", 4, 400, 400)};
  auto other = make_cpu(2, 200, 200);
  other.name = "cpu-large";
  auto arm_only = make_cpu(1, 100, 100);
  arm_only.architectures = {"arm64"};
  asked.nodes[1].architecture = "arm64";
  // The first deployment runs on the second node only.
  add_step(asked, "poses", {arm_only, other});
  CHECK(chosen(allocate(asked)) == choices{{0, 1, -1}});
}

TEST_CASE("the GPU with the lowest index is taken, wherever it is listed") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 400)};
  for (int index : {7, 2, 5})
    asked.nodes[0] = with_gpu(asked.nodes[0], index, 400);
  add_step(asked, "poses", {make_gpu(1, 100, 100, 100)});
  CHECK(chosen(allocate(asked)) == choices{{0, 0, 2}});
}

TEST_CASE("the choice of an earlier step goes before that of a later one") {
  problem asked;
  // Either step alone takes a third of each resource of a node, and two on
  // one node still have equal fractions: everything ties but the load.
  asked.alpha = 0;
  asked.nodes = {make_node("a", 3, 300, 300), make_node("b", 3, 300, 300)};
  for (const char* id : {"first", "second", "third", "fourth"})
    add_step(asked, id, {make_cpu(1, 100, 100)});
  CHECK(chosen(allocate(asked))
        == choices{{0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {1, 0, -1}});
}

TEST_CASE("an earlier allocation that is worse by 1e-12 at most is taken") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 400), make_node("b", 4, 400, 400)};
  add_step(asked, "poses", {make_cpu(1, 100, 100)});
  // A fraction that is off by e has variance 2/9 e^2: 5e-13 for 1.5e-6, and
  // 2e-12 for 3e-6. The amounts are 4 cores times these.
  asked.nodes[0].cpu.capacity = 1 / (0.25 + 1.5e-6);
  CHECK(chosen(allocate(asked)) == choices{{0, 0, -1}});
  asked.nodes[0].cpu.capacity = 1 / (0.25 + 3e-6);
  CHECK(chosen(allocate(asked)) == choices{{1, 0, -1}});
}

TEST_CASE("ties are measured from the minimum, not from one to the next") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 400), make_node("b", 4, 400, 400),
                 make_node("c", 4, 400, 400)};
  add_step(asked, "poses", {make_cpu(1, 100, 100)});
  // Variances 1.5e-12, 0.7e-12 and 0: a ties with b, b ties with c, but a
  // does not tie with the minimum.
  asked.nodes[0].cpu.capacity = 1 / (0.25 + 2.6e-6);
  asked.nodes[1].cpu.capacity = 1 / (0.25 + 1.8e-6);
  CHECK(chosen(allocate(asked)) == choices{{1, 0, -1}});
}

TEST_CASE("equal nodes do not hide each other once one hosts a step") {
  problem asked;
  for (const char* name : {"a", "b", "c"})
    asked.nodes.push_back(make_node(name, 1, 100, 100));
  for (const char* id : {"first", "second", "third"})
    add_step(asked, id, {make_cpu(1, 100, 100)});
  CHECK(chosen(allocate(asked)) == choices{{0, 0, -1}, {1, 0, -1}, {2, 0, -1}});
}

TEST_CASE("a skill that only one of two equal nodes has tells them apart") {
  problem asked;
  asked.nodes = {make_node("a", 4, 400, 400), make_node("b", 4, 400, 400)};
  add_step(asked, "first", {make_cpu(3, 300, 300)});
  add_step(asked, "second", {make_cpu(2, 200, 200)});
  asked.steps[1].nodes_with_skill = {"a"};
  CHECK(chosen(allocate(asked)) == choices{{1, 0, -1}, {0, 0, -1}});
}
