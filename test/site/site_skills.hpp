#pragma once

#include "actors/instances/skills/skill_catalogue.hpp"

#include <string>

/// What the nodes of a site can do: the one operation "work".
namespace roscell::test {

/// The deployments of its one model, with the cores that they take.
constexpr auto tiny_deployment = "hundredth";
constexpr auto small_deployment = "half";
constexpr auto large_deployment = "two";

/// The same for all nodes of all sites.
shared_skill_catalogue site_skills();

} // namespace roscell::test
