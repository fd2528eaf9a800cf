#include "tools/roscell/client/documents.hpp"

#include "schemas/message_catalogue.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

json completed(json node) {
  cli::complete_paper_node(node);
  return node;
}

} // namespace

TEST_CASE("a node on paper leaves out what it does not have or use") {
  const auto node = completed(json::parse(R"({
    "name": "spare", "architecture": "arm64", "cpu": {"capacity": 4},
    "memory_mib": {"capacity": 3911}, "disk_mib": {"capacity": 20000},
    "gpus": [{"index": 0, "memory_mib": {"capacity": 4096}}]})"));
  CHECK(node.at("cpu").at("used") == 0);
  CHECK(node.at("gpus")[0].at("memory_mib").at("used") == 0);
  CHECK_FALSE(validate_document(
      "plan_document",
      {{"nodes", {node}},
       {"skills", json::array()},
       {"request",
        {{"task", "t"},
         {"pipeline", {{{"id", "a"}, {"operation", "o"}, {"model", "m"}}}}}}}));
}

TEST_CASE("what a node on paper says stays as it is") {
  const auto node = json::parse(R"({
    "name": "spare", "architecture": "arm64", "unified_memory": true,
    "cpu": {"capacity": 4, "used": 1}, "memory_mib": {"capacity": 9, "used": 2},
    "disk_mib": {"capacity": 20, "used": 3}, "labels": {"room": "lab"},
    "devices": ["/dev/video0"], "gpus": []})");
  CHECK(completed(node) == node);
}

TEST_CASE("what is no node is left to the schema") {
  for (const auto* text : {"7", "[]", "\"spare\""})
    CHECK(completed(json::parse(text)) == json::parse(text));
  CHECK(completed(json::parse(R"({"cpu": 4, "gpus": 1})")).at("cpu") == 4);
}
