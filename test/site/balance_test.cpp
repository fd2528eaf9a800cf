#include "actors/cell/cell_slots.hpp"
#include "test/site/watch/site_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <numeric>

/// Sizes of cells: the plan that evens them out, and whole batches of nodes.
namespace {

using namespace roscell;
using namespace roscell::test;

// -- the plan ----------------------------------------------------------------

std::vector<cell_size> cells_of(const std::vector<int64_t>& sizes) {
  std::vector<cell_size> result;
  for (size_t i = 0; i < sizes.size(); ++i)
    result.push_back(
        {"c-" + std::to_string(i), "cell-" + std::to_string(i), sizes[i]});
  return result;
}

std::vector<int64_t> carry_out(std::vector<int64_t> sizes,
                               const std::vector<cell_move>& moves) {
  for (const auto& x : moves) {
    sizes[std::stoul(x.from.substr(2))] -= x.count;
    sizes[std::stoul(x.to.substr(2))] += x.count;
  }
  return sizes;
}

int64_t spread_of(const std::vector<int64_t>& sizes) {
  const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
  return *most - *least;
}

/// The fewest moves there are: what each cell has above its share, where the
/// largest cells have the larger shares.
int64_t fewest_moves(std::vector<int64_t> sizes) {
  std::sort(sizes.rbegin(), sizes.rend());
  const auto count = static_cast<int64_t>(sizes.size());
  const auto total = std::accumulate(sizes.begin(), sizes.end(), int64_t{0});
  int64_t result = 0;
  for (int64_t i = 0; i < count; ++i) {
    const auto share = total / count + (i < total % count ? 1 : 0);
    result += std::max(sizes[static_cast<size_t>(i)] - share, int64_t{0});
  }
  return result;
}

TEST_CASE("no cell is asked to move anybody when sizes are even", "[balance]") {
  CHECK(plan_balancing({}).empty());
  CHECK(plan_balancing(cells_of({5})).empty());
  CHECK(plan_balancing(cells_of({0, 0, 0})).empty());
  CHECK(plan_balancing(cells_of({2, 3, 2, 3})).empty());
}

TEST_CASE("an empty cell gets its share from the largest ones", "[balance]") {
  const auto moves = plan_balancing(cells_of({17, 0}));
  REQUIRE(moves.size() == 1);
  CHECK(moves[0].from == "c-0");
  CHECK(moves[0].to == "c-1");
  CHECK(moves[0].count == 8);
}

TEST_CASE("any plan evens out with the fewest moves", "[balance]") {
  std::mt19937 random{7};
  for (int i = 0; i < 2000; ++i) {
    std::vector<int64_t> sizes(1 + random() % 8);
    for (auto& x : sizes)
      x = static_cast<int64_t>(random() % 20);
    const auto moves = plan_balancing(cells_of(sizes));
    CHECK(spread_of(carry_out(sizes, moves)) <= 1);
    int64_t moved = 0;
    for (const auto& x : moves) {
      CHECK(x.count > 0);
      CHECK(x.from != x.to);
      moved += x.count;
    }
    CHECK(moved == fewest_moves(sizes));
  }
}

// -- batches -----------------------------------------------------------------

struct batch {
  site place;
  std::vector<site_party*> coordinators;
  std::vector<site_party*> nodes;

  batch(virtual_time& clock, uint32_t seed, size_t cells, size_t members)
      : place(clock, seed) {
    for (size_t i = 0; i < cells; ++i)
      coordinators.push_back(
          &place.add_coordinator("c-" + std::to_string((i + seed) % cells)));
    for (size_t i = 0; i < members; ++i)
      nodes.push_back(&place.add_node());
    place.faults.longest_delay = std::chrono::milliseconds{place.pick(30)};
  }

  void start(std::vector<site_party*> which, std::chrono::milliseconds within) {
    std::shuffle(which.begin(), which.end(), place.random);
    const auto step = within / std::max<size_t>(which.size(), 1);
    for (auto* x : which) {
      place.start(*x);
      place.pass(step);
    }
  }

  /// Sizes of the living cells, by their own tables, once all nodes that can be
  /// are members; what is left to complain of goes to `left`.
  std::vector<int64_t> sizes() const {
    std::vector<int64_t> result;
    for (const auto* x : coordinators)
      if (x->alive())
        result.push_back(
            static_cast<int64_t>(x->cell_state().registry.active_count()));
    return result;
  }

  bool evens_out(size_t expected) {
    for (auto left = 120s; left > 0s; left -= 2s) {
      place.pass(2s);
      const auto all = sizes();
      const auto total = std::accumulate(all.begin(), all.end(), int64_t{0});
      if (total == static_cast<int64_t>(expected) && spread_of(all) <= 1)
        return true;
    }
    return false;
  }

  std::string text() const {
    std::string result;
    for (const auto x : sizes())
      result += std::to_string(x) + " ";
    return result;
  }
};

unsigned runs() {
  const auto* text = std::getenv("ROSCELL_RUNS");
  return text ? static_cast<unsigned>(std::stoul(text)) / 100 + 1 : 10;
}

/// Runs a batch of 64 over 4 with several seeds; `start` says in what order the
/// parties appear and how many nodes must be members in the end.
void check_batches(const std::function<size_t(batch&)>& start) {
  virtual_time clock;
  const auto* seed = std::getenv("ROSCELL_SEED");
  const auto first =
      seed ? static_cast<uint32_t>(std::stoul(seed)) : std::random_device{}();
  for (uint32_t i = 0; i < (seed ? 1 : runs()); ++i) {
    batch x{clock, first + i, 4, 64};
    const auto members = start(x);
    const bool even = x.evens_out(members);
    if (!even)
      print_events(x.place);
    INFO("seed " << first + i << ": sizes " << x.text());
    CHECK(even);
    // It stays so.
    x.place.pass(20s);
    CHECK(spread_of(x.sizes()) <= 1);
  }
}

TEST_CASE("nodes that start at one moment fill the cells evenly", "[balance]") {
  check_batches([](batch& x) {
    x.start(x.coordinators, 0ms);
    x.place.pass(2s);
    x.start(x.nodes, 0ms);
    return size_t{68};
  });
}

TEST_CASE("nodes that wait for the coordinators fill the cells evenly",
          "[balance]") {
  check_batches([](batch& x) {
    x.start(x.nodes, 1s);
    x.start(x.coordinators, std::chrono::milliseconds{x.place.pick(8000)});
    return size_t{68};
  });
}

TEST_CASE("nodes that see some coordinators only fill the cells evenly",
          "[balance]") {
  check_batches([](batch& x) {
    for (const auto* node : x.nodes) {
      const auto seen = x.place.pick(x.coordinators.size());
      for (size_t i = 0; i < x.coordinators.size(); ++i)
        if (i != seen && x.place.pick(2) == 0)
          x.place.hide(node->index, x.coordinators[i]->index);
    }
    x.start(x.coordinators, 500ms);
    x.start(x.nodes, 500ms);
    return size_t{68};
  });
}

TEST_CASE("cells stay even when one coordinator dies in the middle",
          "[balance]") {
  check_batches([](batch& x) {
    x.start(x.coordinators, 500ms);
    const auto middle = x.place.pick(x.nodes.size());
    x.start({x.nodes.begin(), x.nodes.begin() + static_cast<long>(middle)},
            500ms);
    auto& victim = *x.coordinators[x.place.pick(x.coordinators.size())];
    x.place.kill(victim);
    x.start({x.nodes.begin() + static_cast<long>(middle), x.nodes.end()},
            500ms);
    x.place.pass(60s);
    // Whoever was a member of the dead cell waits for it.
    const auto orphans =
        std::count_if(x.nodes.begin(), x.nodes.end(), [](const auto* node) {
          return node->status().state == node_state::orphaned;
        });
    return x.nodes.size() + 3 - static_cast<size_t>(orphans);
  });
}

TEST_CASE("a batch is even at once although coordinators tell sizes late",
          "[balance]") {
  virtual_time clock;
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    batch x{clock, seed, 4, 60};
    x.place.faults.late_by = 800ms;
    x.place.judge = [&](const site_message& m) {
      const bool between = x.place.parties[m.from]->coordinates
                           && x.place.parties[m.to]->coordinates;
      return between && std::string{m.what} == "frame" ? frame_fate::late
                                                       : frame_fate::passed;
    };
    x.start(x.coordinators, 0ms);
    x.start(x.nodes, 200ms);
    x.place.pass(1s);
    x.place.judge = nullptr;
    const auto all_joined = [&] {
      const auto all = x.sizes();
      return std::accumulate(all.begin(), all.end(), int64_t{0}) == 64;
    };
    for (auto left = 10s; left > 0s && !all_joined(); left -= 1s)
      x.place.pass(1s);
    INFO("seed " << seed << ": sizes " << x.text());
    CHECK(all_joined());
    CHECK(spread_of(x.sizes()) <= 1);
  }
}

TEST_CASE("cells are balanced once what hindered it is gone", "[balance]") {
  virtual_time clock;
  site place{clock, 1};
  auto& late = place.add_coordinator("c-0");
  auto& early = place.add_coordinator("c-1");
  std::vector<site_party*> nodes{&place.add_node(), &place.add_node()};
  place.start(early);
  for (auto* x : nodes)
    place.start(*x);
  place.pass(20s);
  REQUIRE(early.cell_state().registry.active_count() == 3);
  for (const auto* x : nodes)
    place.block(x->index, late.index);
  place.start(late);
  place.pass(20s);
  REQUIRE(late.cell_state().registry.active_count() == 1);
  place.heal_all();
  // Before the place that was kept for it is given up.
  place.pass(60s);
  CHECK(late.cell_state().registry.active_count() == 2);
  CHECK(early.cell_state().registry.active_count() == 2);
}

} // namespace
