#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/reading/variables.hpp"
#include "schemas/validator.hpp"
#include "test/places.hpp"
#include "test/schemas/examples.hpp"
#include "test/schemas/oracle.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

std::vector<schema_error> errors_of(const test::example& x) {
  return document_errors(x.type, x.document, unknown_members::taken);
}

std::vector<std::string> places(const std::vector<schema_error>& errors) {
  std::vector<std::string> result;
  for (const auto& error : errors)
    result.push_back(error.pointer);
  std::sort(result.begin(), result.end());
  return result;
}

/// Values that are wrong in most places, each in its own way.
const std::vector<json> odd_values{nullptr,
                                   true,
                                   -1,
                                   0.5,
                                   1000000000000,
                                   "",
                                   "two words",
                                   "/a",
                                   std::string(200, 'a'),
                                   json::array(),
                                   json::object(),
                                   json::array({"a", 1}),
                                   json::object({{"index", 0}})};

/// Every place of a document, its root left out.
std::vector<json::json_pointer> places_in(const json& document) {
  std::vector<json::json_pointer> result;
  const auto flat = document.flatten();
  for (const auto& [pointer, value] : flat.items())
    for (json::json_pointer at{pointer}; !at.empty(); at = at.parent_pointer())
      result.push_back(at);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

} // namespace

TEST_CASE("every schema has valid and invalid examples") {
  std::map<std::string, std::pair<int, int>> found;
  for (const auto& x : examples())
    ++(x.valid ? found[x.type].first : found[x.type].second);
  for (const auto& type : message_types()) {
    INFO(type.name);
    if (type.kind == message_kind::part)
      continue;
    auto [valid, invalid] = found[std::string{type.name}];
    CHECK(valid > 0);
    CHECK(invalid > 0);
  }
}

TEST_CASE("a valid example has no errors, an invalid one all that it names") {
  for (const auto& x : examples()) {
    INFO(x.name);
    CHECK(places(errors_of(x)) == x.where);
  }
}

TEST_CASE("every error of an example says what was expected and what came") {
  for (const auto& x : examples()) {
    for (const auto& error : errors_of(x)) {
      INFO(x.name << ": " << error.expected);
      CHECK(error.expected.rfind("expected ", 0) == 0);
      auto says_finding =
          error.expected.find(", got ") != std::string::npos
          || error.expected.find(", but it is missing") != std::string::npos;
      CHECK(says_finding);
    }
  }
}

TEST_CASE("an example is parsed to what it says") {
  for (const auto& x : examples()) {
    INFO(x.name);
    auto parsed = parse_document(x.text);
    REQUIRE(std::holds_alternative<json>(parsed));
    CHECK(std::get<json>(parsed) == x.document);
  }
}

TEST_CASE("another validator judges the examples alike") {
  for (const auto& x : examples()) {
    INFO(x.name);
    auto valid = validator::shared().validate(x.type, x.document).empty();
    CHECK(valid == oracle_accepts(x.type, x.document));
  }
}

TEST_CASE("another validator judges damaged examples alike") {
  size_t damaged = 0;
  for (const auto& x : examples()) {
    if (!x.valid || !x.document.is_object())
      continue;
    for (const auto& place : places_in(x.document)) {
      for (const auto& odd : odd_values) {
        auto document = x.document;
        document[place] = odd;
        ++damaged;
        auto valid = validator::shared().validate(x.type, document).empty();
        if (valid != oracle_accepts(x.type, document))
          FAIL(x.name << " with " << odd << " at " << place.to_string());
      }
    }
  }
  CHECK(damaged > 10'000);
}

TEST_CASE("another validator judges examples with a missing part alike") {
  for (const auto& x : examples()) {
    for (const auto& place : places_in(x.document)) {
      auto document = x.document;
      auto& parent = document[place.parent_pointer()];
      if (!parent.is_object())
        continue;
      parent.erase(place.back());
      auto valid = validator::shared().validate(x.type, document).empty();
      if (valid != oracle_accepts(x.type, document))
        FAIL(x.name << " without " << place.to_string());
    }
  }
}

namespace fs = std::filesystem;

namespace {

json request_in(const fs::path& path, const given_values& given = {}) {
  const auto text = read_file(path);
  auto parsed = parse_document(text, format_of(path.string(), text));
  REQUIRE(std::holds_alternative<json>(parsed));
  auto filled = fill_variables(std::get<json>(std::move(parsed)), given);
  REQUIRE(std::holds_alternative<json>(filled));
  auto result = std::get<json>(std::move(filled));
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
    const bool has_robot = file.filename() == "10_variables.yaml";
    const given_values given{
        has_robot ? json{{"robot", "arm"}} : json::object(), {}};
    CHECK(document_errors("task_request", request_in(file, given),
                          unknown_members::refused)
              .empty());
  }
}

TEST_CASE("a topic that an example reads is written by a step of it") {
  for (const auto* name : {"strategy_1", "strategy_2", "strategy_3"}) {
    auto request = request_in(test::source_dir() / "docs/examples/strategies"
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

TEST_CASE("the descriptor of each bundled skill is valid, each model unique") {
  std::set<std::string> models;
  for (const auto& folder :
       fs::directory_iterator{test::source_dir() / "skills"}) {
    const auto file = folder.path() / "skill.json";
    if (!fs::exists(file))
      continue;
    INFO(file);
    auto parsed = parse_document(read_file(file));
    REQUIRE(std::holds_alternative<json>(parsed));
    const auto& descriptor = std::get<json>(parsed);
    CHECK(document_errors("skill_descriptor", descriptor,
                          unknown_members::refused)
              .empty());
    for (const auto& model : descriptor["models"])
      CHECK(models
                .insert(descriptor["operation"].get<std::string>() + " "
                        + model["name"].get<std::string>())
                .second);
  }
  CHECK(models.count("pose_estimation apriltag3") == 1);
}
