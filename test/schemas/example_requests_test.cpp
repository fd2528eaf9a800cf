#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "test/places.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace roscell;
namespace fs = std::filesystem;

namespace {

json read_example(const fs::path& path) {
  std::ostringstream in;
  in << std::ifstream{path}.rdbuf();
  const auto text = in.str();
  auto parsed = parse_document(text, format_of(path.string(), text));
  REQUIRE(std::holds_alternative<json>(parsed));
  auto result = std::get<json>(parsed);
  // `roscell run` takes a task request for granted.
  result.emplace("type", "task_request");
  return result;
}

/// The requests of the ladder, and of the three strategies.
std::vector<fs::path> example_requests() {
  std::vector<fs::path> result;
  for (const auto* folder : {"docs/examples", "docs/examples/strategies"})
    for (const auto& file : fs::directory_iterator{test::source_dir() / folder})
      if (const auto ending = file.path().extension();
          ending == ".json" || ending == ".yaml")
        result.push_back(file.path());
  return result;
}

} // namespace

TEST_CASE("each request file of docs/examples is a valid task request") {
  const auto files = example_requests();
  CHECK(files.size() >= 12);
  for (const auto& file : files) {
    INFO(file);
    CHECK(document_errors("task_request", read_example(file),
                          unknown_members::refused)
              .empty());
  }
}

TEST_CASE("a topic that an example reads is written by a step of it") {
  for (const auto* name : {"strategy_1", "strategy_2", "strategy_3"}) {
    auto request = read_example(test::source_dir() / "docs/examples/strategies"
                                / (std::string{name} + ".json"));
    std::map<std::string, std::string> written;
    for (const auto& step : request["pipeline"])
      for (const auto& output : step["output"])
        written[output["endpoint"]] = output["data_type"];
    for (const auto& step : request["pipeline"])
      if (step["operation"] == "pose_estimation")
        for (const auto& input : step["input"]) {
          INFO(name << " " << input);
          CHECK(written[input["endpoint"]] == input["data_type"]);
        }
  }
}
