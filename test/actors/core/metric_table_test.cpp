#include "actors/core/metric_table.hpp"

#include "actors/core/limits.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("what is counted adds up for each set of labels", "[metrics]") {
  metric_table table;
  table.add(metric::requests, {"task_request", "done"});
  table.add(metric::requests, {"task_request", "done"}, 2);
  table.add(metric::requests, {"cell_query", "done"});
  const auto found = table.samples(metric::requests);
  REQUIRE(found.size() == 2);
  CHECK(found[0].labels[0] == "cell_query");
  CHECK(found[1].sum == 3);
  CHECK(table.samples(metric::heartbeats_sent).empty());
}

TEST_CASE("a value falls into the first bucket that it does not exceed",
          "[metrics]") {
  metric_table table;
  const auto& bounds =
      metric_families()[static_cast<size_t>(metric::allocation_states)].buckets;
  for (const double x : {bounds[0], bounds[1], bounds.back() + 1})
    table.observe(metric::allocation_states, {}, x);
  const auto found = table.samples(metric::allocation_states);
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].counts.size() == bounds.size() + 1);
  CHECK(found[0].counts[0] == 1);
  CHECK(found[0].counts[1] == 1);
  CHECK(found[0].counts.back() == 1);
}

TEST_CASE("labels from outside do not fill the memory", "[metrics]") {
  metric_table table;
  for (size_t i = 0; i < 3 * limits::metric::label_sets; ++i)
    table.add(metric::heartbeats_sent, {std::to_string(i)});
  const auto found = table.samples(metric::heartbeats_sent);
  CHECK(found.size() == limits::metric::label_sets + 1);
  CHECK(found.back().labels[0] == "other");
}

} // namespace roscell::test
