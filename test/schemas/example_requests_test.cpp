#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "test/places.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

using namespace roscell;
namespace fs = std::filesystem;

namespace {

json read_example(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream{path}.rdbuf();
  auto parsed = parse_document(text.str());
  REQUIRE(std::holds_alternative<json>(parsed));
  return std::get<json>(parsed);
}

} // namespace

TEST_CASE("each request file of docs/examples is a valid task request") {
  auto count = 0;
  for (const auto& file :
       fs::directory_iterator{test::source_dir() / "docs/examples"}) {
    if (file.path().extension() != ".json")
      continue;
    INFO(file.path());
    CHECK(document_errors("task_request", read_example(file.path()),
                          unknown_members::refused)
              .empty());
    ++count;
  }
  CHECK(count >= 3);
}

TEST_CASE("a topic that an example reads is written by a step of it") {
  for (const auto* name : {"strategy_1", "strategy_2", "strategy_3"}) {
    auto request = read_example(test::source_dir() / "docs/examples"
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
