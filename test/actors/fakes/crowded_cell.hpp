#pragma once

#include "test/actors/fakes/coordinator_fakes.hpp"

#include <string>

namespace roscell::test {

/// Tasks "a" and "b" of one core each run on node "left"; "right" is empty, and
/// the coordination node is full.
struct crowded_cell : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  crowded_cell() {
    base.has.cpu.used = 4;
    right.has.cpu.used = 4;
    for (const auto* task : {"a", "b"})
      REQUIRE(request(echo_task(task, {echo_step("s0", 1)})).at("type")
              == "task_accepted");
    REQUIRE(left.running.size() == 2);
    right.has.cpu.used = 0;
  }

  std::string node_of(const std::string& task) {
    return request({{"type", "task_query"}, {"task", task}})
        .at("tasks")[0]
        .at("instances")[0]
        .at("node")
        .get<std::string>();
  }
};

} // namespace roscell::test
