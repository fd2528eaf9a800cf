#include "schemas/reading/variables.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

namespace {

/// Declares some variables of each kind beside what uses them.
json document_with(const json& use) {
  return {{"variables",
           {{"camera", "front"},
            {"rate_hz", 5},
            {"live", true},
            {"rooms", {"lab"}},
            {"robot", nullptr}}},
          {"use", use}};
}

given_values given_words(std::map<std::string, std::string> given) {
  given.emplace("robot", "arm-1");
  return {json::object(), std::move(given)};
}

json filled(const json& use,
            const std::map<std::string, std::string>& given = {}) {
  auto result = fill_variables(document_with(use), given_words(given));
  if (const auto* why = std::get_if<failure>(&result))
    FAIL(why->message);
  return std::get<json>(result).at("use");
}

failure unfilled(const json& use,
                 const std::map<std::string, std::string>& given = {}) {
  const auto result = fill_variables(document_with(use), given_words(given));
  REQUIRE(std::holds_alternative<failure>(result));
  return std::get<failure>(result);
}

bool reports(const failure& why, const std::string& words) {
  return why.message.find(words) != std::string::npos;
}

} // namespace

TEST_CASE("a document without variables stays as it is", "[variables]") {
  const json document{{"use", "${camera} $${x}"}};
  CHECK(std::get<json>(fill_variables(document, {})) == document);
  const auto given = fill_variables(document, given_words({}));
  REQUIRE(std::holds_alternative<failure>(given));
  CHECK(reports(std::get<failure>(given), "no \"variables\""));
}

TEST_CASE("a text that is a variable becomes its value, of its kind",
          "[variables]") {
  CHECK(filled("${rate_hz}") == 5);
  CHECK(filled("${live}") == true);
  CHECK(filled("${rooms}") == json{"lab"});
  CHECK(filled("${robot}") == "arm-1");
}

TEST_CASE("inside of a text a value is written out", "[variables]") {
  CHECK(filled("/${camera}/at_${rate_hz}/${live}") == "/front/at_5/true");
  CHECK(filled({{"a", {"x${camera}", 7}}}) == json{{"a", {"xfront", 7}}});
  const auto why = unfilled({{"a/b", {"x ${rooms}"}}});
  CHECK(reports(why, "a list"));
  CHECK(why.where == "/use/a~1b/0");
}

TEST_CASE("two dollars are one, and names of members are not filled in",
          "[variables]") {
  CHECK(filled("echo $${camera} $HOME") == "echo ${camera} $HOME");
  CHECK(filled({{"${camera}", 1}}) == json{{"${camera}", 1}});
}

TEST_CASE("what is given is read as the default is", "[variables]") {
  CHECK(filled("${rate_hz}", {{"rate_hz", "2.5"}}) == 2.5);
  CHECK(filled("${camera}", {{"camera", "12"}}) == "12");
  CHECK(filled("${robot}", {{"robot", "12"}}) == 12);
  CHECK(filled("${rooms}", {{"rooms", "[a, b]"}}) == json({"a", "b"}));
  // A value is not filled in itself.
  CHECK(filled("${camera}", {{"camera", "${rate_hz}"}}) == "${rate_hz}");
}

TEST_CASE("words count more than a file of values", "[variables]") {
  given_values given{{{"robot", "arm-2"}, {"rate_hz", 1}}, {{"rate_hz", "2"}}};
  const auto result =
      fill_variables(document_with({"${robot}", "${rate_hz}"}), given);
  REQUIRE(std::holds_alternative<json>(result));
  CHECK(std::get<json>(result).at("use") == json({"arm-2", 2}));
}

TEST_CASE("a wrong value or name is told with its place", "[variables]") {
  CHECK(unfilled("${rate_hz}", {{"rate_hz", "fast"}}).where
        == "/variables/rate_hz");
  CHECK(reports(unfilled("", {{"camra", "x"}}), "did you mean \"camera\"?"));
  CHECK(reports(unfilled("${camra}"), "did you mean \"camera\"?"));
  CHECK(unfilled({{"a", "${camra}"}}).where == "/use/a");
  CHECK(reports(unfilled("${camera"), "'}'"));
  CHECK(reports(unfilled("${}"), "'}'"));
  const auto missing = fill_variables(document_with("x"), {});
  REQUIRE(std::holds_alternative<failure>(missing));
  CHECK(std::get<failure>(missing).where == "/variables/robot");
  CHECK(reports(std::get<failure>(missing), "--set robot=VALUE"));
}

TEST_CASE("variables are so many, of such names, and make so much text",
          "[variables]") {
  const variable_limits limits{2, 3, 10};
  const auto refused = [&](const json& variables, const json& use) {
    return std::holds_alternative<failure>(
        fill_variables({{"variables", variables}, {"use", use}}, {}, limits));
  };
  CHECK_FALSE(refused({{"a", 1}, {"b", 1}}, ""));
  CHECK(refused({{"a", 1}, {"b", 1}, {"c", 1}}, ""));
  CHECK(refused(json::array(), ""));
  CHECK_FALSE(refused({{"a_1", 1}}, ""));
  CHECK(refused({{"1a", 1}}, ""));
  CHECK(refused({{"a-1", 1}}, ""));
  CHECK(refused({{"abcd", 1}}, ""));
  CHECK_FALSE(refused({{"a", "12345"}}, {"${a}", "${a}"}));
  CHECK(refused({{"a", "12345"}}, {"${a}", "${a}", "${a}"}));
}
