#include "actors/cell/limits.hpp"
#include "actors/cell/tables/node_failures.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

/// A moment of a test's clock.
node_failures::time_point lost_time(std::chrono::milliseconds x) {
  return node_failures::time_point{1h + x};
}

instance_place fenced_place(const std::string& instance,
                            const std::string& node,
                            std::chrono::milliseconds after = 60s) {
  return {"t",   "s", instance, node, "uuid-of-" + node, away_rule::fenced,
          after, {},  {}};
}

instance_place unfenced_place(const std::string& instance,
                              const std::string& node, away_rule rule) {
  return {"t", "s", instance, node, "uuid-of-" + node, rule, 0s, {}, {}};
}

abandoned_step lost_at(const std::string& instance, const std::string& node,
                       node_failures::time_point due) {
  return {"t", "s", instance, node, "uuid-of-" + node, due};
}

} // namespace

TEST_CASE("What runs holds its step until it has ended", "[node_failures]") {
  node_failures x;
  REQUIRE(x.order(fenced_place("i", "left")));
  REQUIRE(x.hold("t", "s", lost_time(0s)));
  CHECK(x.hold("t", "s", lost_time(0s))->until
        == node_failures::time_point::max());
  CHECK_FALSE(x.hold("t", "other", lost_time(0s)));
  CHECK_FALSE(x.hold("u", "s", lost_time(0s)));
  CHECK_FALSE(x.hold("t", "s", lost_time(0s), "i"));
  SECTION("as its own node says") {
    x.end("uuid-of-left", "i");
    CHECK_FALSE(x.hold("t", "s", lost_time(0s)));
  }
  SECTION("and not as another machine of that name says") {
    x.end("uuid-of-twin", "i");
    CHECK(x.hold("t", "s", lost_time(0s)));
  }
  SECTION("or its node registers without it") {
    x.node_back("uuid-of-left", {"other"});
    CHECK(x.find("i", lost_time(0s)) == nullptr);
  }
}

TEST_CASE("A fence is over after_s after the last word, and not before",
          "[node_failures]") {
  const auto after = GENERATE(24'000ms, 24'001ms, 60'000ms, 300'000ms);
  node_failures x;
  x.order(fenced_place("i", "left", after));
  x.node_lost("uuid-of-left", lost_time(5s));
  REQUIRE(x.hold("t", "s", lost_time(5s)));
  CHECK(x.hold("t", "s", lost_time(5s))->until == lost_time(5s + after));
  CHECK(x.hold("t", "s", lost_time(5s + after - 1ms)));
  CHECK_FALSE(x.hold("t", "s", lost_time(5s + after)));
}

TEST_CASE("What its fence has ended is forgotten, and no moment before",
          "[node_failures]") {
  node_failures x;
  REQUIRE(x.order(fenced_place("i", "left")));
  x.node_lost("uuid-of-left", lost_time(0s));
  const auto end = lost_time(0s) + fenced_place("i", "left").after;
  x.forget_ended(end - 1ms);
  CHECK(x.count(end - 1ms) == 1);
  CHECK(x.count(end) == 0);
  CHECK(x.size() == 1);
  x.forget_ended(end);
  CHECK(x.size() == 0);
}

TEST_CASE("Of several fences of a step the last one counts",
          "[node_failures]") {
  node_failures x;
  x.order(fenced_place("i", "left", 300s));
  x.order(fenced_place("j", "right", 24s));
  x.node_lost("uuid-of-left", lost_time(0s));
  x.node_lost("uuid-of-right", lost_time(290s));
  CHECK(x.hold("t", "s", lost_time(310s))->place.instance == "j");
  CHECK_FALSE(x.hold("t", "s", lost_time(314s)));
  SECTION("also for a step that is to be placed anew") {
    x.abandon(lost_at("i", "left", lost_time(0s)));
    CHECK(x.next_due() == lost_time(314s));
    CHECK(x.due(lost_time(313s)).empty());
    CHECK(x.due(lost_time(314s)).at("t").size() == 1);
  }
}

TEST_CASE("A node that was heard of again is lost anew", "[node_failures]") {
  node_failures x;
  x.order(fenced_place("i", "left"));
  x.node_lost("uuid-of-left", lost_time(0s));
  x.node_back("uuid-of-left", {"i"});
  CHECK(x.hold("t", "s", lost_time(100s)));
  x.node_lost("uuid-of-left", lost_time(100s));
  CHECK(x.hold("t", "s", lost_time(159s)));
  CHECK_FALSE(x.hold("t", "s", lost_time(160s)));
}

TEST_CASE("Without a fence a place holds for as long as its node is away",
          "[node_failures]") {
  node_failures x;
  x.order(unfenced_place("i", "left", away_rule::waits));
  x.node_lost("uuid-of-left", lost_time(0s));
  CHECK(x.hold("t", "s", lost_time(24h)));
  // A task of that name may be begun by somebody who knows.
  CHECK_FALSE(x.hold_of_task("t", lost_time(24h)));
  SECTION("until the cell has no such node") {
    x.node_gone("uuid-of-left", lost_time(24h));
  }
  SECTION("until its task is begun anew") {
    x.forget_waiting("t");
  }
  CHECK_FALSE(x.hold("t", "s", lost_time(24h)));
}

TEST_CASE("What its host starts alone holds its step until somebody knows",
          "[node_failures]") {
  node_failures x;
  x.order(unfenced_place("i", "left", away_rule::alone));
  x.forget_alone("t");
  REQUIRE(x.hold("t", "s", lost_time(0s)));
  x.node_lost("uuid-of-left", lost_time(0s));
  CHECK(x.hold_of_task("t", lost_time(24h)));
  x.node_gone("uuid-of-left", lost_time(24h));
  CHECK(x.hold_of_task("t", lost_time(24h)));
  x.forget_alone("t");
  CHECK_FALSE(x.hold_of_task("t", lost_time(24h)));
}

TEST_CASE("A node that has left counts from then on", "[node_failures]") {
  node_failures x;
  x.order(fenced_place("i", "left"));
  CHECK(x.nodes_there() == std::set<std::string>{"uuid-of-left"});
  x.node_gone("uuid-of-left", lost_time(10s));
  x.node_gone("uuid-of-left", lost_time(20s));
  CHECK(x.nodes_there().empty());
  CHECK(x.hold("t", "s", lost_time(69s)));
  CHECK_FALSE(x.hold("t", "s", lost_time(70s)));
}

TEST_CASE("Of a task all that is removed is gone, but what is waited for",
          "[node_failures]") {
  node_failures x;
  x.order(fenced_place("i", "left"));
  x.order(fenced_place("j", "left"));
  x.order(fenced_place("k", "right"));
  x.end_all("uuid-of-left", "t", {"j"});
  CHECK(x.find("i", lost_time(0s)) == nullptr);
  CHECK(x.find("j", lost_time(0s)) != nullptr);
  CHECK(x.find("k", lost_time(0s)) != nullptr);
}

TEST_CASE("No more places are known than a limit", "[node_failures]") {
  node_failures x;
  for (size_t i = 0; i < limits::task::places; ++i)
    REQUIRE(x.order(fenced_place("i" + std::to_string(i), "left")));
  CHECK_FALSE(x.has_room(1));
  CHECK_FALSE(x.order(fenced_place("one more", "left")));
  CHECK(x.order(fenced_place("i0", "left")));
  x.end("uuid-of-left", "i7");
  CHECK(x.has_room(1));
  CHECK(x.order(fenced_place("one more", "left")));
  CHECK(x.size() == limits::task::places);
}

TEST_CASE("A step without a place is tried again with longer pauses",
          "[node_failures]") {
  node_failures x;
  x.abandon(lost_at("i", "left", lost_time(10s)));
  x.abandon(lost_at("i", "right", lost_time(0s))); // It is known.
  CHECK(x.next_due() == lost_time(10s));
  x.give_up("i");
  CHECK(x.is_abandoned("i"));
  x.postpone("i", "no room", lost_time(10s));
  CHECK_FALSE(x.is_abandoned("i"));
  CHECK(x.find_abandoned("i")->problem == "no room");
  CHECK(x.next_due() > lost_time(10s));
  x.pause("i", lost_time(10min));
  CHECK(x.next_due() == lost_time(10min));
  x.forget("i");
  CHECK(x.next_due() == node_failures::time_point::max());
}

TEST_CASE("What has had no place can be hurried, but not past a fence",
          "[node_failures]") {
  node_failures x;
  x.abandon(lost_at("i", "left", lost_time(10s)));
  x.hurry(lost_time(1s));
  CHECK(x.next_due() == lost_time(10s)); // It has not been tried.
  x.pause("i", lost_time(10min));
  x.postpone("i", "no room", lost_time(11s));
  x.hurry(lost_time(11s));
  CHECK(x.next_due() == lost_time(11s));
  SECTION("nor while it is being placed") {
    x.pause("i", lost_time(10min));
    x.hurry(lost_time(12s));
    CHECK(x.next_due() == lost_time(10min));
  }
  SECTION("that still counts") {
    x.order(fenced_place("i", "left"));
    x.node_lost("uuid-of-left", lost_time(0s));
    x.hurry(lost_time(12s));
    CHECK(x.next_due() == lost_time(60s));
  }
}

} // namespace roscell::test
