#include "client/columns.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

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
          "[client]") {
  const auto kinds = described_columns();
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
