#include "actors/placement/reading/changeable_parameters.hpp"

#include "test/actors/placement/reading/pipelines.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

skill_descriptor tunable() {
  return skill_of("mixer", {{"text/plain"}, {"file"}}, {}, R"({
           "gain": {"type": "number", "default": 1, "maximum": 9,
                    "changeable": true},
           "size": {"type": "integer", "default": 4},
           "queue_length": 2})")
      .skill.descriptor;
}

std::string refusal_of(const skill_descriptor& skill, const json& wanted) {
  const auto why = refused_parameters(skill, "m", wanted);
  return why ? why->where + ": " + why->message : "";
}

} // namespace

TEST_CASE("only parameters that are declared changeable can be set") {
  CHECK(refusal_of(tunable(), {{"gain", 2}}).empty());
  CHECK(refusal_of(tunable(), {{"gain", 2}, {"size", 5}})
        == "/parameters/size: 'size' cannot be changed while the skill runs; "
           "what can is gain");
  // What engines understand they read once.
  CHECK(refusal_of(tunable(), {{"queue_length", 4}}).find("cannot be changed")
        != std::string::npos);
  CHECK(has_changeable_parameter(tunable(), "m"));
  CHECK_FALSE(has_changeable_parameter(tunable(), "other"));
}

TEST_CASE("values that are set are checked as those of a task") {
  CHECK(refusal_of(tunable(), {{"gain", 10}}).find("/parameters/gain: expected")
        == 0);
  CHECK(refusal_of(tunable(), {{"gainn", 1}}).find("did you mean \"gain\"")
        != std::string::npos);
}

TEST_CASE("programs that take no parameters while they run say what does") {
  auto actor = tunable();
  actor.engine = "actor";
  CHECK(refusal_of(actor, {{"gain", 2}}).find("is an actor")
        != std::string::npos);
  CHECK_FALSE(has_changeable_parameter(actor, "m"));
  auto stock = tunable();
  stock.ros2.push_back({});
  const auto why = refused_parameters(stock, "m", {{"gain", 2}});
  REQUIRE(why);
  CHECK(why->hint == "`ros2 param set` changes them");
}

TEST_CASE("an event tells of long values what they are") {
  const json list(1000, 7);
  const auto shown = short_values({{"gain", 2}, {"list", list}});
  CHECK(shown.at("gain") == 2);
  CHECK(shown.at("list") == "an array of 1000 items");
}
