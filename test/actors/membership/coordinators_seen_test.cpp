#include "actors/membership/coordinators_seen.hpp"
#include "actors/membership/limits.hpp"

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

std::string arbiter_of(const coordinators_seen& seen) {
  const auto* arbiter = seen.slot_arbiter();
  return arbiter ? arbiter->uuid : "";
}

} // namespace

TEST_CASE("The coordinator with the lowest UUID that answers is asked",
          "[coordinators_seen]") {
  coordinators_seen seen;
  CHECK(arbiter_of(seen).empty());
  seen.see(coordinator("b"));
  seen.see(coordinator("a"));
  CHECK(arbiter_of(seen) == "a");
  seen.mark_unresponsive("a");
  CHECK(arbiter_of(seen) == "b");
  seen.mark_unresponsive("b");
  CHECK(arbiter_of(seen).empty());
  seen.forgive();
  CHECK(arbiter_of(seen) == "a");
}

TEST_CASE("A silent coordinator is asked again once it says something new",
          "[coordinators_seen]") {
  coordinators_seen seen;
  seen.see(coordinator("a"));
  seen.mark_unresponsive("a");
  seen.see(coordinator("a"));
  CHECK(arbiter_of(seen).empty());
  seen.see(coordinator("a", 2));
  CHECK(arbiter_of(seen) == "a");
}

TEST_CASE("False coordinators are few, and make room when they do not answer",
          "[coordinators_seen]") {
  coordinators_seen seen;
  for (size_t i = 0; i < limits::unauthenticated_peers::slot_arbiters; ++i)
    CHECK(seen.see(coordinator("0" + std::to_string(i))));
  CHECK_FALSE(seen.see(coordinator("true")));
  const auto asked = arbiter_of(seen);
  seen.mark_unresponsive(asked);
  CHECK(seen.see(coordinator("true")));
  CHECK(seen.size() == limits::unauthenticated_peers::slot_arbiters);
  for (size_t i = 1; i < limits::unauthenticated_peers::slot_arbiters; ++i)
    seen.mark_unresponsive(arbiter_of(seen));
  CHECK(arbiter_of(seen) == "true");
}

TEST_CASE("Whoever vanishes is not asked", "[coordinators_seen]") {
  coordinators_seen seen;
  seen.see(coordinator("a"));
  seen.mark_unresponsive("nobody");
  seen.vanish("a");
  CHECK(arbiter_of(seen).empty());
  CHECK(seen.size() == 0);
}

} // namespace roscell::test
