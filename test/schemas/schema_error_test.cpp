#include "schemas/schema_error.hpp"

#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("one error becomes a refusal that says and shows it") {
  auto why = to_failure({{"/task", "expected a name, but it is missing"}});
  CHECK(why.code == error_code::schema_violation);
  CHECK(why.where == "/task");
  CHECK(why.message == "/task: expected a name, but it is missing");
  auto errors = json::parse(why.details);
  CHECK(errors == json::parse(R"({"errors":[{"where":"/task",
             "expected":"expected a name, but it is missing"}]})"));
}

TEST_CASE("several errors are counted in the message and listed in full") {
  auto why = to_failure({{"", "expected a"}, {"/b", "expected c"}});
  CHECK(why.message == "the document: expected a (and 1 more error)");
  CHECK(json::parse(why.details)["errors"].size() == 2);
  CHECK_FALSE(json::parse(why.details).contains("more"));
}

TEST_CASE("of very many errors fifty are listed and the others counted") {
  auto why = to_failure(std::vector<schema_error>(73, {"/x", "expected y"}));
  auto details = json::parse(why.details);
  CHECK(details["errors"].size() == 50);
  CHECK(details["more"] == 23);
  CHECK(why.message == "/x: expected y (and 72 more errors)");
}
