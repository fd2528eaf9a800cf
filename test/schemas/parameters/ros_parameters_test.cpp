#include "schemas/parameters/declared_parameter.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

declared_parameter declared(const std::string& type,
                            const std::string& items = {}) {
  declared_parameter result;
  result.type = type;
  result.items = items;
  result.is_declared = true;
  return result;
}

declared_parameter by_default(const json& value) {
  return read_parameters({{"x", value}}).at("x");
}

std::string for_program(const json& value, const declared_parameter& known) {
  return ros_text(value, &known, ros_reader::program);
}

std::string for_launch(const std::string& text) {
  return ros_text(text, nullptr, ros_reader::launch_file);
}

} // namespace

TEST_CASE("a value reaches a ROS 2 program in the type that is declared") {
  CHECK(for_program(2, declared("number")) == "2.0");
  CHECK(for_program(2, declared("integer")) == "2");
  CHECK(for_program(2.5, declared("number")) == "2.5");
  CHECK(for_program(true, declared("boolean")) == "true");
  CHECK(for_program("2", declared("string")) == "\"2\"");
  CHECK(ros_text(2, nullptr, ros_reader::program) == "2");
}

TEST_CASE("where only a default is said its form counts") {
  CHECK(for_program(2, by_default(0.5)) == "2.0");
  CHECK(for_program(2, by_default(7)) == "2");
  CHECK(for_program({1, 2}, by_default(json::array({0.5}))) == "[1.0,2.0]");
}

TEST_CASE("a list reaches a ROS 2 program with items of the declared type") {
  CHECK(for_program({1, 2}, declared("array", "number")) == "[1.0,2.0]");
  CHECK(for_program({1, 2}, declared("array", "integer")) == "[1,2]");
  CHECK(for_program({1, 2.5}, declared("array")) == "[1.0,2.5]");
  CHECK(for_program({"a", "2"}, declared("array", "string")) == R"(["a","2"])");
}

TEST_CASE("text for a launch file is in quotes where YAML would retype it") {
  for (const auto* text :
       {"36",    "-1",         "1_000", "0x1F", "123E5", "1.5",  ".5",
        "12:30", "true",       "Yes",   "off",  "n",     "null", "~",
        ".inf",  "2026-11-27", "",      " a",   "a: b",  "a #b", "[1]",
        "{a}",   "*x",         "- a",   "@x",   "a:"}) {
    INFO(text);
    CHECK(for_launch(text) == json(text).dump());
  }
  for (const auto* text :
       {"36h11", "tag36h11", "/camera/image", "192.168.1.10", "1.2.3", "a b",
        "none", "package://x/y.urdf", "--quiet", "a:b", "truer"}) {
    INFO(text);
    CHECK(for_launch(text) == text);
  }
}

TEST_CASE("what ROS 2 cannot be given is refused with its place") {
  const json values{{"fine", {1, 2.5}},
                    {"empty", json::array()},
                    {"mixed", {1, "a"}},
                    {"nested", {{1}, {2}}},
                    {"none", nullptr},
                    {"nul", std::string("a\0b", 3)},
                    {"nul_in", json::array({std::string("a\0b", 3)})},
                    {"object", {{"a", 1}}},
                    {"large", 9223372036854775808U}};
  std::vector<std::string> places;
  for (const auto& x : ros_errors(values, ros_reader::program, "/p")) {
    places.push_back(x.pointer);
    CHECK(x.expected.rfind("expected ", 0) == 0);
    CHECK(x.expected.find(", got ") != std::string::npos);
  }
  CHECK(places
        == std::vector<std::string>{"/p/empty", "/p/large", "/p/mixed",
                                    "/p/nested", "/p/none", "/p/nul",
                                    "/p/nul_in", "/p/object"});
  // Text for a launch file may be an empty list.
  CHECK(ros_problem(json::array(), ros_reader::launch_file).empty());
}
