#include "actors/placement/search/allocation.hpp"

#include "builders.hpp"
#include "random_cases.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int default_busy_cases = 1000;
#else
constexpr int default_busy_cases = 3000;
#endif

/// A node of two cores, all taken by others, who would share 0.5 of them.
problem busy_node() {
  problem asked;
  asked.nodes.push_back(make_node("n", 2, 100, 100));
  asked.nodes[0].cpu.used = 2;
  asked.nodes[0].cpu_compressible = 0.5;
  return asked;
}

/// Others take every core of every machine but for `left` of one.
void make_busy(oracle::instance& in, double left) {
  for (auto& x : in.machines)
    x.cpu.u = std::max(x.cpu.u, x.cpu.c - left);
}

} // namespace

TEST_CASE("a step finds room where others would share their cores") {
  auto asked = busy_node();
  add_step(asked, "s", {make_cpu(0.5, 1, 1)});
  auto made = allocate_with_floor(asked);
  REQUIRE(made.found.optimal());
  CHECK(made.cpu_floor);
  CHECK(made.found.placements[0].shares.cpu == Approx(1));
}

TEST_CASE("a step that fits a strict reading is placed by it") {
  auto asked = busy_node();
  asked.nodes[0].cpu.used = 1.5;
  add_step(asked, "s", {make_cpu(0.5, 1, 1)});
  auto made = allocate_with_floor(asked);
  REQUIRE(made.found.optimal());
  CHECK_FALSE(made.cpu_floor);
  CHECK(made.found.placements[0].shares.cpu == Approx(1));
}

TEST_CASE("nobody shares more than what is compressible") {
  auto asked = busy_node();
  add_step(asked, "s", {make_cpu(0.6, 1, 1)});
  auto made = allocate_with_floor(asked);
  REQUIRE(made.found.what == outcome::infeasible);
  REQUIRE(made.found.rejected.size() == 1);
  CHECK(made.found.rejected[0].reasons[0].text
        == "needs 0.6 cores, 0.5 free: short by 0.1");
  asked.nodes[0].cpu_compressible = 0;
  CHECK(allocate_with_floor(asked).found.what == outcome::infeasible);
}

TEST_CASE("a refusal in the strict reading does not bind the floored one") {
  auto asked = busy_node();
  asked.nodes[0].cpu.used = 1.5;
  add_step(asked, "s", {make_cpu(0.5, 1, 1)});
  asked.excluded.push_back({0, 0, 0, -1, "refused by the node", false});
  auto made = allocate_with_floor(asked);
  REQUIRE(made.found.optimal());
  CHECK(made.cpu_floor);
  asked.excluded.push_back({0, 0, 0, -1, "refused by the node", true});
  CHECK(allocate_with_floor(asked).found.what == outcome::infeasible);
}

TEST_CASE(
    "a node that was busy when it refused is asked again when it is not") {
  problem asked;
  asked.nodes.push_back(make_node("n", 2, 100, 100));
  add_step(asked, "s", {make_cpu(0.5, 1, 1)});
  asked.excluded.push_back({0, 0, 0, -1, "refused by the node", false});
  const auto made = allocate_with_floor(asked);
  REQUIRE(made.found.optimal());
  CHECK(made.cpu_floor);
}

TEST_CASE("cores that others would share may not be below zero") {
  auto asked = busy_node();
  asked.nodes[0].cpu_compressible = -1;
  add_step(asked, "s", {make_cpu(0.5, 1, 1)});
  auto made = allocate_with_floor(asked);
  CHECK(made.found.what == outcome::invalid);
  CHECK(made.found.message.find("nodes[0].cpu_compressible")
        != std::string::npos);
}

TEST_CASE("both readings equal those of a brute force on random cases") {
  int strict = 0;
  int floored = 0;
  int neither = 0;
  auto cases = case_count(default_busy_cases);
  for (int seed = 1; seed <= cases; ++seed) {
    INFO("seed " << seed);
    auto in = random_instance(static_cast<std::uint32_t>(seed));
    make_busy(in, seed % 4 == 0 ? 1 : 0);
    auto asked = translated(in);
    auto relaxed = in;
    for (std::size_t v = 0; v < in.machines.size(); ++v) {
      auto shared = 0.25 * static_cast<double>((v + seed) % 9);
      asked.nodes[v].cpu_compressible = shared;
      relaxed.machines[v].cpu.u = std::max(0.0, in.machines[v].cpu.u - shared);
    }
    auto wanted = oracle::solve(in);
    const bool fits_strictly = wanted.feasible;
    if (!fits_strictly)
      wanted = oracle::solve(relaxed);
    auto made = allocate_with_floor(asked);
    if (!wanted.feasible) {
      ++neither;
      REQUIRE(made.found.what == outcome::infeasible);
      continue;
    }
    ++(fits_strictly ? strict : floored);
    REQUIRE(made.found.optimal());
    REQUIRE(made.cpu_floor == !fits_strictly);
    REQUIRE(picks(made.found) == wanted.picks);
    REQUIRE(made.found.value.total
            == Approx(wanted.total).epsilon(1e-12).margin(1e-12));
  }
  // Cases of one kind only would prove little.
  CHECK(strict > cases / 50);
  CHECK(floored > cases / 20);
  CHECK(neither > cases / 50);
}
