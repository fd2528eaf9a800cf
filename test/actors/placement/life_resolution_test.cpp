#include "actors/placement/life_resolution.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

/// A step with its skill.
struct step_with_skill {
  task_step step;
  deployment_option option;
  skill_descriptor descriptor;

  life_policy life() const {
    return life_of(step, option, descriptor.safe_state);
  }

  std::string refused_at() const {
    const auto why = check_life(step, option, descriptor);
    return why ? why->where : "";
  }
};

} // namespace

TEST_CASE("After a boot a step goes on as it says, or as its skill says",
          "[life_resolution]") {
  step_with_skill x;
  CHECK(boot_action_of(x.life()) == boot_action::rejoin);
  x.option.on_boot = "start";
  CHECK(boot_action_of(x.life()) == boot_action::start);
  x.step.on_boot = "stay";
  CHECK(boot_action_of(x.life()) == boot_action::stay);
}

TEST_CASE(
    "What runs once, or must not be found moving, stays unless it says so",
    "[life_resolution]") {
  step_with_skill x;
  SECTION("it runs once") {
    x.step.restart = R"({"policy": "never"})";
  }
  SECTION("it has to be stop-safe before it ends") {
    x.descriptor.safe_state = true;
  }
  CHECK(boot_action_of(x.life()) == boot_action::stay);
  x.step.on_boot = "rejoin";
  CHECK(boot_action_of(x.life()) == boot_action::rejoin);
  CHECK(x.refused_at().empty());
}

TEST_CASE("What may be elsewhere by then does not start alone",
          "[life_resolution]") {
  step_with_skill x;
  x.step.on_boot = "start";
  CHECK(x.refused_at().empty());
  x.step.on_node_loss = R"({"policy": "move"})";
  CHECK(x.refused_at() == "/on_boot");
}

TEST_CASE("A robot that must be safe starts alone only where its skill says so",
          "[life_resolution]") {
  step_with_skill x;
  x.descriptor.safe_state = true;
  x.step.on_boot = "start";
  CHECK(x.refused_at() == "/on_boot");
  x.descriptor.may_start_alone = true;
  CHECK(x.refused_at().empty());
}

} // namespace roscell::test
