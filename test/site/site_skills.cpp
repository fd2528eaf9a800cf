#include "test/site/site_skills.hpp"

#include "test/actors/fakes/supervision_fakes.hpp"

namespace roscell::test {

namespace {

constexpr auto descriptor = R"({
  "operation": "work", "engine": "primitive", "entry_point": ["bin/work"],
  "input": { "data_types": ["text/plain"], "protocols": ["file"] },
  "output": { "data_types": ["text/plain"], "protocols": ["file"] },
  "models": [ { "name": "plain", "parameters": {
    "ready_ms": { "type": "integer" }, "ends_ms": { "type": "integer" },
    "exit_code": { "type": "integer" }, "stop_ms": { "type": "integer" },
    "cannot_start": { "type": "boolean" } }, "deployments": [
    { "name": "hundredth", "base_image": "debian:bookworm-slim",
      "architectures": ["amd64"],
      "resources": { "cpu": 0.01, "memory_mib": 1, "disk_mib": 1 } },
    { "name": "half", "base_image": "debian:bookworm-slim",
      "architectures": ["amd64"],
      "resources": { "cpu": 0.5, "memory_mib": 16, "disk_mib": 5 } },
    { "name": "two", "base_image": "debian:bookworm-slim",
      "architectures": ["amd64"],
      "resources": { "cpu": 2.0, "memory_mib": 64, "disk_mib": 5 } } ] } ] })";

/// The folder stays for as long as somebody may look into it.
struct skill_shelf {
  skill_shelf() {
    folder.write("work/skill.json", descriptor);
    folder.write("work/bin/work", "#!/bin/sh\n", true);
    skills = std::make_shared<const skill_catalogue>(
        skill_catalogue::scan({folder.path()}));
    REQUIRE(skills->skills().size() == 1);
  }

  temp_folder folder;
  shared_skill_catalogue skills;
};

} // namespace

shared_skill_catalogue site_skills() {
  static const skill_shelf shelf;
  return shelf.skills;
}

} // namespace roscell::test
