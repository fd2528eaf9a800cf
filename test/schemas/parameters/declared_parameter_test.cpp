#include "schemas/parameters/declared_parameter.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

const json declarations = json::parse(R"({
  "size": {"type": "number", "default": 0.08, "minimum": 0, "maximum": 1,
           "unit": "m"},
  "kind": {"type": "string", "values": ["a", "b"]},
  "count": {"type": "integer", "default": 2},
  "loop": true
})");

std::string problem(const std::string& name, const json& value) {
  return value_problem(read_parameters(declarations).at(name), value);
}

} // namespace

TEST_CASE("a value must have a parameter's type, range and words") {
  CHECK(problem("size", 0.5).empty());
  CHECK(problem("size", 1).empty());
  CHECK(problem("size", 1.5)
        == "expected a number from 0 to 1 (m), got the number 1.5");
  CHECK(problem("size", "big")
        == "expected a number from 0 to 1 (m), got \"big\"");
  CHECK(problem("kind", "b").empty());
  CHECK(problem("kind", "c") == "expected one of \"a\", \"b\", got \"c\"");
  CHECK(problem("count", 3).empty());
  CHECK(problem("count", 2.5) == "expected an integer, got the number 2.5");
  CHECK(problem("loop", false).empty());
  CHECK(problem("loop", 1) == "expected true or false, got the number 1");
}

TEST_CASE("defaults are those of declarations and plain values") {
  CHECK(parameter_defaults(declarations)
        == json::parse(R"({"size": 0.08, "count": 2, "loop": true})"));
}

TEST_CASE("a default outside its own range is an error of the descriptor") {
  const auto errors = declaration_errors(
      json::parse(R"({"a": {"type": "number", "default": 5, "maximum": 1},
                      "b": {"type": "number", "minimum": 3, "maximum": 1},
                      "c": 7})"),
      "/models/0/parameters");
  REQUIRE(errors.size() == 2);
  CHECK(errors[0].pointer == "/models/0/parameters/a/default");
  CHECK(errors[1].pointer == "/models/0/parameters/b/minimum");
}

TEST_CASE("a model knows the parameters of its engine and protocols") {
  skill_descriptor skill;
  skill.engine = "primitive";
  skill.input = {{"image/png"}, {"file"}};
  implementation_model model;
  model.parameters = R"({"rate_hz": 5})";
  auto known = parameters_of(skill, model);
  CHECK(known.count("queue_length") == 1);
  CHECK(known.count("follow") == 1);
  CHECK(known.count("ros2_depth") == 0);
  // A plain default keeps what the protocol says of the parameter.
  CHECK(known.at("rate_hz").value == 5);
  CHECK(known.at("rate_hz").unit == "Hz");
  skill.engine = "other";
  CHECK(parameters_of(skill, model).size() == 1);
}

TEST_CASE("an unknown parameter is refused with those that there are") {
  declared_parameters known{{"tag_size_m", {}}, {"blur", {}}};
  auto errors = parameter_errors(
      known, json::parse(R"({"tag_size": 1, "z": 2, "blur": 0})"), "/p");
  REQUIRE(errors.size() == 2);
  CHECK(errors[0].pointer == "/p/tag_size");
  CHECK(errors[0].expected
        == R"(there is no parameter "tag_size"; did you mean "tag_size_m"?)");
  CHECK(errors[1].expected
        == R"(there is no parameter "z"; there are blur, tag_size_m)");
}
