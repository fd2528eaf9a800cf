#include "tools/roscell/dashboard/pages.hpp"
#include "tools/roscell/view/columns.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

/// What the script exports under a name.
json exported(const std::string& name) {
  const auto& script = described_script();
  const auto head = "export const " + name + " = ";
  const auto begin = script.find(head) + head.size();
  return json::parse(script.substr(begin, script.find(";\n", begin) - begin));
}

/// A row of each kind in which everything is said.
json full_row(const std::string& kind) {
  instance_row instance;
  instance.restarts = 1;
  instance.metrics = {1, 1, 1, 1};
  instance.metrics.use.memory_mib = 1;
  instance.metrics.use.cpu = 1;
  if (kind == "instances")
    return instance;
  if (kind == "tasks")
    return task_row{"t", task_state::running, 1, 0, {instance}};
  if (kind == "topics")
    return topic_row{"/a", "b", {}, {}, {"why"}};
  return registry_row{};
}

} // namespace

TEST_CASE("each column that the dashboard shows is read from what is there",
          "[dashboard]") {
  const auto kinds = exported("COLUMNS");
  for (const auto* kind : {"nodes", "tasks", "instances", "topics"}) {
    const auto row = full_row(kind);
    size_t keys = 0;
    for (const auto& x : kinds.at(kind)) {
      INFO(kind << " " << x.dump());
      keys += x.at("as") == "key" ? 1 : 0;
      CHECK(row.contains(json::json_pointer(x.at("path").get<std::string>())));
    }
    CHECK(keys == 1);
  }
}

TEST_CASE("the dashboard is told which answers an event makes old",
          "[dashboard]") {
  const auto stale = exported("STALE");
  CHECK(stale.at(0) == json{"node_joined", {"cell", "cells", "skills"}});
}
