#include "random_cases.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <tuple>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

constexpr double exact = 1e-12;
// Enough to meet each rule hundreds of times; fewer where a sanitizer makes
// the enumeration many times slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int default_cases = 3000;
#else
constexpr int default_cases = 6000;
#endif

bool near(double left, double right) {
  return std::abs(left - right) <= exact * std::max(1.0, std::abs(right));
}

bool same_details(const placement& made, const oracle::details& wanted) {
  bool same = near(made.variance, wanted.variance)
              && near(made.shares.cpu, wanted.f[0])
              && near(made.shares.memory, wanted.f[1])
              && near(made.shares.disk, wanted.f[2])
              && made.shares.gpu_memory.has_value() == (wanted.f.size() == 4);
  return same
         && (wanted.f.size() < 4 || near(*made.shares.gpu_memory, wanted.f[3]));
}

void check_optimum(const result& answer, const oracle::answer& wanted) {
  REQUIRE(answer.optimal());
  REQUIRE(picks(answer) == wanted.picks);
  REQUIRE(near(answer.value.total, wanted.total));
  REQUIRE(near(answer.value.balance, wanted.balance));
  REQUIRE(near(answer.value.load, wanted.load));
  REQUIRE(answer.lower_bound == answer.value.total);
  for (std::size_t i = 0; i < wanted.steps.size(); ++i)
    REQUIRE(same_details(answer.placements[i], wanted.steps[i]));
}

/// Every candidate that is not compatible alone is rejected exactly once and
/// with a reason; when infeasible, every candidate at all.
void check_rejected(const oracle::instance& in, const result& answer) {
  std::map<std::tuple<std::size_t, int, int, int>, int> seen;
  for (const auto& one : answer.rejected) {
    REQUIRE_FALSE(one.reasons.empty());
    for (const auto& why : one.reasons)
      REQUIRE_FALSE(why.text.empty());
    auto key = std::tuple(one.step, static_cast<int>(one.node),
                          static_cast<int>(one.deployment), one.gpu);
    REQUIRE(++seen[key] == 1);
  }
  for (std::size_t i = 0; i < in.tasks.size(); ++i) {
    auto usable = oracle::compatible_together(in, static_cast<int>(i));
    for (const auto& p : usable)
      REQUIRE(seen.count({i, p.v, p.d, p.g}) == (answer.optimal() ? 0 : 1));
    std::size_t rejected = 0;
    for (const auto& one : seen)
      rejected += std::get<0>(one.first) == i ? 1 : 0;
    auto all = static_cast<std::size_t>(
        oracle::all_candidates(in, static_cast<int>(i)));
    REQUIRE(rejected == (answer.optimal() ? all - usable.size() : all));
  }
}

/// The steps named as a conflict have no allocation even without the others.
void check_conflict(oracle::instance in, const result& answer) {
  REQUIRE(answer.what == outcome::infeasible);
  REQUIRE_FALSE(answer.conflict.empty());
  REQUIRE_FALSE(answer.message.empty());
  std::vector<oracle::task> core;
  for (auto i : answer.conflict)
    core.push_back(in.tasks[i]);
  in.tasks = core;
  REQUIRE_FALSE(oracle::solve(in).feasible);
}

/// Whatever the moment of the stop, the bound is below the optimum and the
/// allocation is not better than it.
void check_stopped(const problem& asked, const oracle::answer& wanted,
                   int branches) {
  limits stop;
  stop.cancelled = [&branches] { return branches-- <= 0; };
  auto answer = allocate(asked, stop);
  if (answer.optimal()) {
    REQUIRE(picks(answer) == wanted.picks);
    return;
  }
  REQUIRE(answer.what != outcome::infeasible);
  REQUIRE(answer.lower_bound <= wanted.total + exact);
  if (answer.has_allocation())
    REQUIRE(answer.value.total >= wanted.total - exact);
}

} // namespace

TEST_CASE("allocations equal those of a brute force on random cases") {
  int feasible = 0;
  auto cases = case_count(default_cases);
  for (int seed = 1; seed <= cases; ++seed) {
    INFO("seed " << seed);
    auto in = random_instance(static_cast<std::uint32_t>(seed));
    auto wanted = oracle::solve(in);
    auto asked = translated(in);
    auto answer = allocate(asked);
    if (wanted.feasible) {
      ++feasible;
      check_optimum(answer, wanted);
      check_stopped(asked, wanted, seed % 97);
    } else {
      check_conflict(in, answer);
    }
    check_rejected(in, answer);
  }
  // Cases of one kind only would prove little.
  CHECK(feasible > cases / 4);
  CHECK(cases - feasible > cases / 20);
}
