#include "tools/roscell/shell/follower.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

event some_event(const char* what, const char* subject,
                 const char* data = "{}") {
  event e;
  e.what = what;
  e.subject = subject;
  e.data = data;
  return e;
}

} // namespace

TEST_CASE("a filter that names nothing takes every event", "[shell]") {
  CHECK(event_filter{}.takes(some_event("node_joined", "arm")));
  CHECK(event_filter{}.text() == "all events");
}

TEST_CASE("events are filtered by kind", "[shell]") {
  const event_filter filter{{"node_*", "task_failed"}, {}};
  CHECK(filter.takes(some_event("node_lost", "arm")));
  CHECK(filter.takes(some_event("task_failed", "t")));
  CHECK_FALSE(filter.takes(some_event("task_accepted", "t")));
  CHECK_FALSE(filter.takes(some_event("node", "arm")));
}

TEST_CASE("events are filtered by whom they are about", "[shell]") {
  const event_filter filter{{}, {"arm", "t"}};
  CHECK(filter.takes(some_event("node_lost", "arm")));
  CHECK(filter.takes(
      some_event("instance_changed", "t-a-1", R"({"task":"t","step":"a"})")));
  CHECK(filter.takes(
      some_event("instance_changed", "u-a-1", R"({"node":"arm"})")));
  CHECK_FALSE(filter.takes(some_event("node_lost", "belt")));
  CHECK_FALSE(filter.takes(some_event("node_lost", "arm-2", "")));
}

TEST_CASE("kind and subject must both fit", "[shell]") {
  const event_filter filter{{"node_lost"}, {"arm"}};
  CHECK(filter.takes(some_event("node_lost", "arm")));
  CHECK_FALSE(filter.takes(some_event("node_joined", "arm")));
  CHECK_FALSE(filter.takes(some_event("node_lost", "belt")));
  CHECK(filter.text() == "node_lost of arm");
}
