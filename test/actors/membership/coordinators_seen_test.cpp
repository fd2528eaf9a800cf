#include "actors/membership/coordinators_seen.hpp"

#include "actors/house/limits.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

node_presence coordinator(const std::string& uuid, int64_t incarnation = 1) {
  node_presence result;
  result.role = "coordinator";
  result.uuid = uuid;
  result.incarnation = incarnation;
  return result;
}

std::string giver_of(const coordinators_seen& seen) {
  const auto* giver = seen.place_giver();
  return giver ? giver->uuid : "";
}

} // namespace

TEST_CASE("The coordinator with the lowest UUID that answers is asked",
          "[coordinators_seen]") {
  coordinators_seen seen;
  CHECK(giver_of(seen).empty());
  seen.see(coordinator("b"));
  seen.see(coordinator("a"));
  CHECK(giver_of(seen) == "a");
  seen.mark_silent("a");
  CHECK(giver_of(seen) == "b");
  seen.mark_silent("b");
  CHECK(giver_of(seen).empty());
  seen.forgive();
  CHECK(giver_of(seen) == "a");
}

TEST_CASE("A silent coordinator is asked again once it says something new",
          "[coordinators_seen]") {
  coordinators_seen seen;
  seen.see(coordinator("a"));
  seen.mark_silent("a");
  seen.see(coordinator("a"));
  CHECK(giver_of(seen).empty());
  seen.see(coordinator("a", 2));
  CHECK(giver_of(seen) == "a");
}

TEST_CASE("False coordinators are few, and make room when they do not answer",
          "[coordinators_seen]") {
  coordinators_seen seen;
  for (size_t i = 0; i < limits::strangers::place_givers; ++i)
    CHECK(seen.see(coordinator("0" + std::to_string(i))));
  CHECK_FALSE(seen.see(coordinator("true")));
  const auto asked = giver_of(seen);
  seen.mark_silent(asked);
  CHECK(seen.see(coordinator("true")));
  CHECK(seen.size() == limits::strangers::place_givers);
  for (size_t i = 1; i < limits::strangers::place_givers; ++i)
    seen.mark_silent(giver_of(seen));
  CHECK(giver_of(seen) == "true");
}

TEST_CASE("Whoever vanishes is not asked", "[coordinators_seen]") {
  coordinators_seen seen;
  seen.see(coordinator("a"));
  seen.mark_silent("nobody");
  seen.vanish("a");
  CHECK(giver_of(seen).empty());
  CHECK(seen.size() == 0);
}

} // namespace roscell::test
