#include "actors/house/metric_book.hpp"

#include "actors/house/limits.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("what is counted adds up for each set of labels", "[metrics]") {
  metric_book book;
  book.add(metric::requests, {"task_request", "done"});
  book.add(metric::requests, {"task_request", "done"}, 2);
  book.add(metric::requests, {"cell_query", "done"});
  const auto found = book.samples(metric::requests);
  REQUIRE(found.size() == 2);
  CHECK(found[0].labels[0] == "cell_query");
  CHECK(found[1].sum == 3);
  CHECK(book.samples(metric::beats_sent).empty());
}

TEST_CASE("a value falls into the first bucket that it does not exceed",
          "[metrics]") {
  metric_book book;
  const auto& bounds =
      metric_families()[static_cast<size_t>(metric::allocation_states)].buckets;
  for (const double x : {bounds[0], bounds[1], bounds.back() + 1})
    book.observe(metric::allocation_states, {}, x);
  const auto found = book.samples(metric::allocation_states);
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].counts.size() == bounds.size() + 1);
  CHECK(found[0].counts[0] == 1);
  CHECK(found[0].counts[1] == 1);
  CHECK(found[0].counts.back() == 1);
}

TEST_CASE("labels from outside do not fill the memory", "[metrics]") {
  metric_book book;
  for (size_t i = 0; i < 3 * limits::metric::label_sets; ++i)
    book.add(metric::beats_sent, {std::to_string(i)});
  const auto found = book.samples(metric::beats_sent);
  CHECK(found.size() == limits::metric::label_sets + 1);
  CHECK(found.back().labels[0] == "other");
}

} // namespace roscell::test
