#include "schemas/reading/placeholder.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

json filled(const std::string& text) {
  json document{{"text", text}};
  fill_placeholder(document, "node", "r1");
  return document.at("text");
}

} // namespace

TEST_CASE("A placeholder is filled in wherever a text has it",
          "[placeholder]") {
  json document = json::parse(R"({
    "${node}": "${node}", "list": ["/${node}/scan", {"deep": "${node}${node}"}],
    "number": 3, "nothing": null})");
  fill_placeholder(document, "node", "r1");
  CHECK(document == json::parse(R"({"${node}": "r1", "list": ["/r1/scan",
                           {"deep": "r1r1"}], "number": 3, "nothing": null})"));
}

TEST_CASE("What is escaped or has another name stays", "[placeholder]") {
  CHECK(filled("$${node}") == "${node}");
  CHECK(filled("a$${node}b${node}") == "a${node}br1");
  CHECK(filled("${copy} ${nod} ${node") == "${copy} ${nod} ${node");
  CHECK(filled("$ {node} $") == "$ {node} $");
}

TEST_CASE("A name that looks like a placeholder is not filled in again",
          "[placeholder]") {
  json document{{"text", "${node}"}};
  fill_placeholder(document, "node", "${node}");
  CHECK(document.at("text") == "${node}");
}

TEST_CASE("A number alone is a number, and a word in a text", "[placeholder]") {
  json document{{"alone", "${copy}"}, {"within", "no. ${copy}"}};
  fill_placeholder(document, "copy", int64_t{3});
  CHECK(document == json{{"alone", 3}, {"within", "no. 3"}});
}

TEST_CASE("An escaped placeholder is none", "[placeholder]") {
  CHECK(has_placeholder("/a/${copy}", "copy"));
  CHECK(has_placeholder("/$${copy}/${copy}", "copy"));
  CHECK_FALSE(has_placeholder("/$${copy}", "copy"));
  CHECK_FALSE(has_placeholder("/${node}", "copy"));
}

} // namespace roscell::test
