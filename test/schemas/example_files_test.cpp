#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/validator.hpp"
#include "test/schemas/examples.hpp"
#include "test/schemas/oracle.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>

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
