#pragma once

#include "test/actors/fakes/coordinator_fakes.hpp"

#include <string>

namespace roscell::test {

/// A step that has to be stop-safe before it may be ended.
inline json grasp_step(const std::string& id, const std::string& node = "") {
  auto result = echo_step(id, 1, node);
  result["operation"] = "grasp";
  return result;
}

/// Nodes "left" and "right" have both skills; the coordination node is full.
struct careful_cell : paper_cell {
  fake_agent& left = make_agent("left");
  fake_agent& right = make_agent("right");

  careful_cell() {
    for (auto* x : {&left, &right}) {
      x->skills = {echo_skill(), grasp_skill()};
      REQUIRE(enter(*x));
    }
    base.has.cpu.used = 4;
  }

  /// The instance of a step.
  static std::string on(const fake_agent& node, const std::string& step) {
    for (const auto& [id, row] : node.running)
      if (row.spec.step == step)
        return id;
    return "";
  }

  json task_of(const std::string& task) {
    return request({{"type", "task_query"}, {"task", task}}).at("tasks").at(0);
  }

  /// A program ends by itself, with 0.
  void finish(fake_agent& node, const std::string& instance) {
    auto row = node.running.at(instance);
    node.running.erase(instance);
    row.state = instance_state::stopped;
    row.exit_code = 0;
    node.report_row(row);
    time.settle();
  }
};

} // namespace roscell::test
