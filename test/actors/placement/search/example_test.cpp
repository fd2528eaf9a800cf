#include "builders.hpp"

#include <catch2/catch.hpp>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

Approx exactly(double value) {
  return Approx(value).margin(1e-12).epsilon(0);
}

/// Two idle nodes of different size, the example of docs/allocation.md.
problem two_nodes() {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000), make_node("b", 2, 400, 500)};
  return asked;
}

} // namespace

TEST_CASE("one step goes where its fractions vary least") {
  auto asked = two_nodes();
  add_step(asked, "poses", {make_cpu(1, 100, 50)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(chosen(answer) == choices{{0, 0, -1}});
  // On a: fractions 1/4, 1/10, 1/20, mean 2/15, population variance 13/1800.
  // On b: fractions 1/2, 1/4, 1/10, mean 17/60, population variance 49/1800.
  // One node alone has no load variance.
  CHECK(answer.placements[0].shares.cpu == exactly(1.0 / 4));
  CHECK(answer.placements[0].shares.memory == exactly(1.0 / 10));
  CHECK(answer.placements[0].shares.disk == exactly(1.0 / 20));
  CHECK_FALSE(answer.placements[0].shares.gpu_memory);
  CHECK(answer.placements[0].variance == exactly(13.0 / 1800));
  CHECK(answer.placements[0].bonus == 0);
  CHECK(answer.value.balance == exactly(13.0 / 1800));
  CHECK(answer.value.load == 0);
  CHECK(answer.value.total == exactly(13.0 / 1800));
  CHECK(answer.lower_bound == answer.value.total);
  CHECK(answer.message.empty());
}

TEST_CASE("a step's fractions are of what earlier steps on its node leave") {
  auto asked = two_nodes();
  add_step(asked, "first", {make_cpu(1, 100, 50)});
  add_step(asked, "second", {make_cpu(1, 100, 50)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(chosen(answer) == choices{{0, 0, -1}, {0, 0, -1}});
  // The second sees 3 cores, 900 and 950 MiB: 1/3, 1/9, 1/19, whose variance
  // is 3848/263169. Their mean is below the 31/1800 of one step on each node.
  CHECK(answer.placements[1].shares.cpu == exactly(1.0 / 3));
  CHECK(answer.placements[1].shares.memory == exactly(1.0 / 9));
  CHECK(answer.placements[1].shares.disk == exactly(1.0 / 19));
  CHECK(answer.placements[1].variance == exactly(3848.0 / 263169));
  CHECK(answer.value.total == exactly((13.0 / 1800 + 3848.0 / 263169) / 2));
  CHECK(answer.value.load == 0);
}

TEST_CASE("the load term is the variance over the nodes that host a step") {
  auto asked = two_nodes();
  // A third node that hosts nothing has no part in it.
  asked.nodes.push_back(make_node("c", 1, 50, 50));
  asked.nodes[1].labels["room"] = "lab";
  add_step(asked, "first", {make_cpu(1, 100, 50)});
  add_step(asked, "second", {make_cpu(1, 100, 50)});
  asked.steps[1].labels["room"] = "lab";
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(chosen(answer) == choices{{0, 0, -1}, {1, 0, -1}});
  // Loads: a (1/4 + 1/10) / 2 = 7/40, b (1/2 + 1/4) / 2 = 3/8. Mean 11/40,
  // each 1/10 away from it.
  CHECK(answer.value.load == exactly(1.0 / 100));
  CHECK(answer.value.balance == exactly(31.0 / 1800));
  CHECK(answer.value.total == exactly(31.0 / 1800 + 0.1 / 100));
}

TEST_CASE("what a node uses already counts for its load and its fractions") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000)};
  asked.nodes[0].cpu.used = 2;
  asked.nodes[0].memory_mib.used = 500;
  asked.nodes[0].disk_mib.used = 500;
  asked.nodes.push_back(make_node("b", 4, 1000, 1000));
  asked.nodes[1].labels["only"] = "b";
  add_step(asked, "first", {make_cpu(1, 100, 50)});
  add_step(asked, "second", {make_cpu(1, 100, 50)});
  asked.steps[0].nodes_with_skill = {"a"};
  asked.steps[1].nodes_with_skill = {"b"};
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.placements[0].shares.cpu == exactly(1.0 / 2));
  CHECK(answer.placements[0].shares.memory == exactly(1.0 / 5));
  CHECK(answer.placements[0].shares.disk == exactly(1.0 / 10));
  // Loads: a (3/4 + 6/10) / 2 = 27/40, b (1/4 + 1/10) / 2 = 7/40: each is
  // 1/4 away from the mean.
  CHECK(answer.value.load == exactly(1.0 / 16));
}

TEST_CASE("the weight of the load decides between spreading and stacking") {
  problem asked;
  asked.nodes = {make_node("busy", 4, 1000, 1000),
                 make_node("idle", 4, 1000, 1000)};
  asked.nodes[0].cpu.used = 2;
  asked.nodes[0].memory_mib.used = 500;
  asked.nodes[0].disk_mib.used = 500;
  // On the idle node 1/2, 0, 0 has variance 1/18 and then, with all of the
  // cores left, 1, 0, 0 has 2/9. On the busy one 1, 0, 0 has 2/9 at once.
  // Balance is a tie, so the load term decides: stacked it is 0.
  add_step(asked, "first", {make_cpu(2, 0, 0)});
  add_step(asked, "second", {make_cpu(2, 0, 0)});
  auto answer = allocate(asked);
  CHECK(chosen(answer) == choices{{1, 0, -1}, {1, 0, -1}});
  CHECK(answer.value.load == 0);
  // Without the load term, the first of the tied allocations is taken.
  asked.alpha = 0;
  answer = allocate(asked);
  CHECK(chosen(answer) == choices{{0, 0, -1}, {1, 0, -1}});
  // Loads (1 + 1/2) / 2 and (1/2 + 0) / 2 are told though they do not count.
  CHECK(answer.value.load == exactly(1.0 / 16));
  CHECK(answer.value.total == exactly((2.0 / 9 + 1.0 / 18) / 2));
}

TEST_CASE("a GPU deployment has four fractions and the bonus") {
  problem asked;
  asked.nodes = {with_gpu(make_node("a", 4, 1000, 1000), 3, 800)};
  asked.nodes[0].gpus[0].memory_mib.used = 400;
  add_step(asked, "poses", {make_gpu(1, 100, 50, 100)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(chosen(answer) == choices{{0, 0, 3}});
  // 1/4, 1/10, 1/20 and 1/4: mean 13/80, squared distances from it
  // 49/6400, 25/6400, 81/6400 and 49/6400.
  REQUIRE(answer.placements[0].shares.gpu_memory);
  CHECK(*answer.placements[0].shares.gpu_memory == exactly(1.0 / 4));
  CHECK(answer.placements[0].variance == exactly(204.0 / 6400 / 4));
  CHECK(answer.placements[0].bonus == -0.01);
  CHECK(answer.value.total == exactly(204.0 / 6400 / 4 - 0.01));
}

TEST_CASE("the bonus decides between a CPU and a GPU that fit equally well") {
  problem asked;
  asked.nodes = {with_gpu(make_node("a", 4, 400, 400), 0, 400)};
  add_step(asked, "poses", {make_cpu(1, 100, 100), make_gpu(1, 100, 100, 100)});
  CHECK(chosen(allocate(asked)) == choices{{0, 1, 0}});
  asked.gpu_bonus = 0.01;
  CHECK(chosen(allocate(asked)) == choices{{0, 0, -1}});
}

TEST_CASE("GPU memory precedes on the same GPU only") {
  problem asked;
  asked.nodes = {
      with_gpu(with_gpu(make_node("a", 8, 8000, 8000), 0, 1000), 1, 1000)};
  add_step(asked, "first", {make_gpu(1, 1000, 1000, 600)});
  add_step(asked, "second", {make_gpu(1, 1000, 1000, 600)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  // 600 MiB twice do not fit on one GPU of 1000, yet on one each.
  CHECK(chosen(answer) == choices{{0, 0, 0}, {0, 0, 1}});
  CHECK(*answer.placements[1].shares.gpu_memory == exactly(0.6));
  // Node resources do precede: 1 of 7 cores.
  CHECK(answer.placements[1].shares.cpu == exactly(1.0 / 7));
}

TEST_CASE("on unified memory the counterpart is reserved first") {
  problem asked;
  asked.nodes = {unified(make_node("jetson", 4, 8000, 1000))};
  add_step(asked, "detect", {make_gpu(1, 1000, 100, 3000)});
  add_step(asked, "filter", {make_cpu(1, 1000, 100)});
  add_step(asked, "track", {make_gpu(0, 1000, 0, 500)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(chosen(answer) == choices{{0, 0, 0}, {0, 0, -1}, {0, 0, 0}});
  const auto& made = answer.placements;
  // Of 8000 MiB: 1000 of the 5000 beside its GPU memory, and 3000 of the
  // 7000 beside its memory. 1/4, 1/5, 1/10, 3/7: variance 4451/313600.
  CHECK(made[0].shares.memory == exactly(1.0 / 5));
  CHECK(*made[0].shares.gpu_memory == exactly(3.0 / 7));
  CHECK(made[0].variance == exactly(4451.0 / 313600));
  // 4000 MiB are left for the next, which needs no GPU: 1/3, 1/4, 1/9.
  CHECK(made[1].shares.memory == exactly(1.0 / 4));
  CHECK(made[1].variance == exactly(49.0 / 5832));
  // 3000 MiB are left for the last: 1000 of 2500, and 500 of 2000.
  CHECK(made[2].shares.memory == exactly(2.0 / 5));
  CHECK(*made[2].shares.gpu_memory == exactly(1.0 / 4));
  CHECK(made[2].shares.cpu == 0);
}

TEST_CASE("the load of a unified-memory node leaves GPU memory out") {
  problem asked;
  asked.nodes = {unified(make_node("jetson", 4, 8000, 1000)),
                 make_node("box", 4, 8000, 1000)};
  add_step(asked, "detect", {make_gpu(1, 1000, 100, 3000)});
  add_step(asked, "filter", {make_cpu(1, 1000, 100)});
  asked.steps[1].nodes_with_skill = {"box"};
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  // Both nodes have a core and 1000 MiB taken.
  CHECK(answer.value.load == 0);
}

TEST_CASE("unified memory holds memory and GPU memory together, no more") {
  problem asked;
  asked.nodes = {unified(make_node("jetson", 4, 1000, 1000))};
  add_step(asked, "detect", {make_gpu(0, 400, 0, 600)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.placements[0].shares.memory == 1);
  CHECK(*answer.placements[0].shares.gpu_memory == 1);
  asked.steps[0].deployments[0].gpu_memory_mib = 601;
  CHECK(allocate(asked).what == outcome::infeasible);
}

TEST_CASE("a resource without a request has fraction 0 and still counts") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 0)};
  add_step(asked, "poses", {make_cpu(2, 500, 0)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.placements[0].shares.disk == 0);
  // 1/2, 1/2, 0: mean 1/3, variance 1/18.
  CHECK(answer.value.total == exactly(1.0 / 18));
}

TEST_CASE("a full node still takes a step that asks for nothing") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000)};
  asked.nodes[0].cpu.used = 4;
  asked.nodes[0].memory_mib.used = 1000;
  asked.nodes[0].disk_mib.used = 1000;
  add_step(asked, "first", {make_cpu(0, 0, 0)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.value.total == 0);
}

TEST_CASE("an exact fit is a fit, in spite of rounding") {
  problem asked;
  asked.nodes = {make_node("a", 0.3, 1000, 1000)};
  for (const char* id : {"first", "second", "third"})
    add_step(asked, id, {make_cpu(0.1, 0, 0)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.placements[2].shares.cpu == exactly(1));
}

TEST_CASE("a request fits up to 1e-9 above what is free and no further") {
  problem asked;
  asked.nodes = {make_node("a", 1, 1000, 1000)};
  add_step(asked, "poses", {make_cpu(1 + 5e-10, 0, 0)});
  CHECK(allocate(asked).optimal());
  asked.steps[0].deployments[0].cpu = 1 + 2e-9;
  CHECK(allocate(asked).what == outcome::infeasible);
}

TEST_CASE("a request below the tolerance on a full node has fraction 1") {
  problem asked;
  asked.nodes = {make_node("a", 1, 1000, 1000)};
  asked.nodes[0].cpu.used = 1;
  add_step(asked, "poses", {make_cpu(5e-10, 0, 0)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.placements[0].shares.cpu == 1);
}

TEST_CASE("use above capacity counts as full, with a warning") {
  problem asked;
  asked.nodes = {make_node("a", 4, 1000, 1000), make_node("b", 4, 1000, 1000)};
  asked.nodes[0] = with_gpu(asked.nodes[0], 2, 100);
  asked.nodes[0].cpu.used = 5;
  asked.nodes[0].gpus[0].memory_mib.used = 150;
  add_step(asked, "first", {make_cpu(0, 100, 0)});
  add_step(asked, "second", {make_cpu(0, 100, 0)});
  asked.steps[0].nodes_with_skill = {"a"};
  asked.steps[1].nodes_with_skill = {"b"};
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  CHECK(answer.warnings
        == std::vector<std::string>{
            "node 'a' has 5.0 of 4.0 cores used; it counts as full",
            "GPU 2 of node 'a' has 150 of 100 MiB of memory used; it counts as "
            "full"});
  // The load of a full node is that of 4 cores: (4/4 + 1/10) / 2 and
  // (0 + 1/10) / 2 are each 1/4 away from the mean.
  CHECK(answer.value.load == exactly(1.0 / 16));
}

TEST_CASE("steps of one pipeline may not take more than there is together") {
  problem asked;
  asked.nodes = {make_node("a", 2, 1000, 1000), make_node("b", 2, 1000, 1000)};
  for (const char* id : {"first", "second", "third"})
    add_step(asked, id, {make_cpu(1, 100, 100)});
  auto answer = allocate(asked);
  REQUIRE(answer.optimal());
  asked.nodes.pop_back();
  CHECK(allocate(asked).what == outcome::infeasible);
}
