#include "actors/placement/search/running/eviction.hpp"

#include "../builders.hpp"
#include "../random_cases.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>
#include <random>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

using positions = std::vector<std::size_t>;

holder held(std::size_t node, int priority, double cpu, double memory = 0) {
  holder result;
  result.node = node;
  result.priority = priority;
  result.cpu = cpu;
  result.memory_mib = memory;
  return result;
}

/// Two full nodes of four cores, and a step of so many.
problem full_cell(double cores) {
  problem result;
  for (const auto* name : {"a", "b"}) {
    result.nodes.push_back(make_node(name, 4, 100, 100));
    result.nodes.back().cpu.used = 4;
  }
  add_step(result, "s", {make_cpu(cores, 0, 0)});
  return result;
}

/// How many go, then their priorities, the highest first.
std::vector<int> price_of(const std::vector<holder>& holders,
                          const positions& gone) {
  std::vector<int> result;
  for (const auto i : gone)
    result.push_back(holders[i].priority);
  std::sort(result.rbegin(), result.rend());
  result.insert(result.begin(), static_cast<int>(gone.size()));
  return result;
}

/// All subsets, each tried.
std::optional<std::vector<int>> cheapest(const problem& asked,
                                         const std::vector<holder>& holders) {
  std::optional<std::vector<int>> best;
  for (unsigned set = 0; set < 1U << holders.size(); ++set) {
    positions gone;
    for (std::size_t i = 0; i < holders.size(); ++i)
      if ((set >> i & 1) != 0)
        gone.push_back(i);
    const auto price = price_of(holders, gone);
    if ((!best || price < *best)
        && allocate(without(asked, holders, gone)).has_allocation())
      best = price;
  }
  return best;
}

/// What runs on the nodes of a random case, and is in use there.
std::vector<holder> add_holders(problem& to, std::uint32_t seed) {
  std::mt19937 random{seed};
  const auto below = [&](int n) {
    return std::uniform_int_distribution<>(0, n - 1)(random);
  };
  std::vector<holder> result;
  for (int i = below(7); i > 0; --i) {
    holder x;
    x.node = static_cast<std::size_t>(below(static_cast<int>(to.nodes.size())));
    x.priority = below(4);
    x.cpu = below(5);
    x.memory_mib = below(3);
    x.disk_mib = below(2);
    auto& host = to.nodes[x.node];
    if (!host.gpus.empty() && below(2) == 0) {
      auto& card = host.gpus[static_cast<std::size_t>(
          below(static_cast<int>(host.gpus.size())))];
      x.gpu = card.index;
      x.gpu_memory_mib = below(4);
      (host.unified_memory ? host.memory_mib : card.memory_mib).used +=
          x.gpu_memory_mib;
    }
    host.cpu.used += x.cpu;
    host.memory_mib.used += x.memory_mib;
    host.disk_mib.used += x.disk_mib;
    result.push_back(x);
  }
  return result;
}

} // namespace

TEST_CASE("Of what could be preempted the fewest go, then the lowest",
          "[eviction]") {
  SECTION("one instead of two that are lower") {
    const auto found = find_eviction(
        full_cell(2), {held(0, 0, 1), held(0, 0, 1), held(1, 3, 2)});
    CHECK(found.what == outcome::optimal);
    CHECK(found.holders == positions{2});
  }
  SECTION("of two that would do the lower one") {
    const auto found =
        find_eviction(full_cell(2), {held(0, 4, 2), held(1, 3, 2)});
    CHECK(found.holders == positions{1});
  }
  SECTION("of several on one node those that are needed") {
    const auto found =
        find_eviction(full_cell(3), {held(0, 1, 1), held(0, 2, 1),
                                     held(0, 3, 1), held(0, 9, 2)});
    CHECK(found.holders == positions{0, 3});
  }
}

TEST_CASE("What fits makes nobody go", "[eviction]") {
  auto asked = full_cell(2);
  asked.nodes[1].cpu.used = 2;
  const auto found = find_eviction(asked, {held(0, 0, 2), held(1, 0, 2)});
  CHECK(found.what == outcome::optimal);
  CHECK(found.holders.empty());
}

TEST_CASE("Where all going is not enough, nobody goes", "[eviction]") {
  const auto found = find_eviction(full_cell(4), {held(0, 0, 3)});
  CHECK(found.what == outcome::infeasible);
  CHECK(found.holders.empty());
}

TEST_CASE("A search for what goes ends when its time is over", "[eviction]") {
  limits bounds;
  bounds.cancelled = [] { return true; };
  const auto found = find_eviction(full_cell(2), {held(0, 0, 2)}, bounds);
  CHECK(found.what == outcome::undecided);
}

TEST_CASE("What must go is as cheap as the cheapest of all subsets",
          "[eviction][random]") {
  for (int seed = 0; seed < case_count(400); ++seed) {
    const auto number = static_cast<std::uint32_t>(seed);
    auto asked = translated(random_instance(number));
    const auto holders = add_holders(asked, number);
    const auto wanted = cheapest(asked, holders);
    const auto found = find_eviction(asked, holders);
    INFO("seed " << seed);
    if (!wanted) {
      REQUIRE(found.what == outcome::infeasible);
      continue;
    }
    REQUIRE(found.what == outcome::optimal);
    REQUIRE(price_of(holders, found.holders) == *wanted);
    REQUIRE(allocate(without(asked, holders, found.holders)).has_allocation());
  }
}
