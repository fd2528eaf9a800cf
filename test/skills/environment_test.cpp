#include "roscell/skill/environment.hpp"

#include "roscell/skill/errors.hpp"

#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace roscell::engine;
using Catch::Matchers::Contains;

namespace {

using variables = std::map<std::string, std::string>;

const std::string one_stream =
    R"([{"protocol":"file","endpoint":"/in","data_type":"text/plain"}])";

variables complete() {
  return {{"ROSCELL_MODEL", "plain"},
          {"ROSCELL_INPUTS", one_stream},
          {"ROSCELL_OUTPUTS", "[]"}};
}

environment read(const variables& from) {
  return read_environment([&](const char* name) {
    auto i = from.find(name);
    return i == from.end() ? nullptr : i->second.c_str();
  });
}

/// The complaint about an environment in which one variable is changed.
std::string complaint(const std::string& name, const std::string& value) {
  auto from = complete();
  from[name] = value;
  try {
    read(from);
  } catch (const start_error& e) {
    return e.what();
  }
  return "none";
}

} // namespace

TEST_CASE("a skill reads a secret that its step names, and no other file") {
  const roscell::test::temp_folder folder{"secrets/key", "value\n"};
  folder.write("outside", "x");
  folder.write("secrets/long", std::string(64 * 1024 + 1, 'x'));
  auto from = complete();
  CHECK_THROWS_WITH(read(from).secret("key"), Contains("\"secrets\""));
  from["ROSCELL_SECRETS"] = folder / "secrets";
  const auto env = read(from);
  CHECK(env.secret("key") == "value\n");
  CHECK_THROWS_WITH(env.secret("none"), Contains("secret 'none' is not given"));
  CHECK_THROWS_AS(env.secret("../outside"), start_error);
  CHECK_THROWS_AS(env.secret(""), start_error);
  CHECK_THROWS_WITH(env.secret("long"), Contains("64 KiB"));
}

TEST_CASE("the environment of a skill has sensible defaults") {
  auto env = read(complete());
  CHECK(env.model == "plain");
  REQUIRE(env.inputs.size() == 1);
  CHECK(env.inputs[0].protocol == "file");
  CHECK(env.inputs[0].endpoint == "/in");
  CHECK(env.inputs[0].data_type == "text/plain");
  CHECK(env.outputs.empty());
  CHECK(env.parameters.text("prefix", "none") == "none");
  CHECK_FALSE(env.gpu);
  CHECK_FALSE(env.watchdog);
  CHECK(env.notify_socket.empty());
  CHECK_FALSE(env.health);
}

TEST_CASE("the environment of a skill is read completely") {
  auto from = complete();
  from["ROSCELL_TASK"] = "t";
  from["ROSCELL_STEP"] = "s";
  from["ROSCELL_INSTANCE"] = "i";
  from["ROSCELL_OPERATION"] = "o";
  from["ROSCELL_DEPLOYMENT"] = "d";
  from["ROSCELL_GPU"] = "1";
  from["ROSCELL_PARAMETERS"] = R"({"prefix":"> "})";
  from["NOTIFY_SOCKET"] = "@x";
  from["WATCHDOG_USEC"] = "2000000";
  from["ROSCELL_HEALTH"] = "1";
  auto env = read(from);
  CHECK(env.task + env.step + env.instance + env.operation + env.deployment
        == "tsiod");
  CHECK(env.gpu == 1u);
  CHECK(env.parameters.text("prefix", "") == "> ");
  CHECK(env.notify_socket == "@x");
  CHECK(env.watchdog == std::chrono::seconds{2});
  CHECK(env.health);
}

TEST_CASE("a wrong variable is named in the complaint") {
  CHECK_THAT(complaint("ROSCELL_MODEL", ""),
             Contains("ROSCELL_MODEL is not set"));
  CHECK_THAT(complaint("ROSCELL_INPUTS", ""), Contains("ROSCELL_INPUTS"));
  CHECK_THAT(complaint("ROSCELL_INPUTS", "[{"), Contains("is not JSON"));
  CHECK_THAT(complaint("ROSCELL_INPUTS", "[]"), Contains("1 to 64"));
  CHECK_THAT(complaint("ROSCELL_INPUTS", "7"), Contains("JSON array"));
  CHECK_THAT(complaint("ROSCELL_INPUTS", "[7]"),
             Contains("ROSCELL_INPUTS[0] must be a JSON object"));
  CHECK_THAT(complaint("ROSCELL_OUTPUTS", R"([{"protocol":"file"}])"),
             Contains("ROSCELL_OUTPUTS[0]") && Contains("endpoint"));
  CHECK_THAT(complaint("ROSCELL_OUTPUTS", R"([{"protocol":1}])"),
             Contains("protocol"));
  CHECK_THAT(complaint("ROSCELL_PARAMETERS", "[]"),
             Contains("ROSCELL_PARAMETERS must be a JSON object"));
  CHECK_THAT(complaint("ROSCELL_PARAMETERS", "{\"a\": \xff}"),
             Contains("ROSCELL_PARAMETERS is not JSON"));
  CHECK_THAT(complaint("ROSCELL_GPU", "-1"), Contains("ROSCELL_GPU"));
  CHECK_THAT(complaint("WATCHDOG_USEC", "1s"), Contains("WATCHDOG_USEC"));
  CHECK_THAT(complaint("WATCHDOG_USEC", "99999999999999999999"),
             Contains("WATCHDOG_USEC"));
}

TEST_CASE("a step may have many streams, but not any number") {
  std::string list = "[";
  for (auto i = 0; i < 64; ++i)
    list += one_stream.substr(1, one_stream.size() - 2) + ",";
  list.back() = ']';
  CHECK(complaint("ROSCELL_INPUTS", list) == "none");
  list.back() = ',';
  list += one_stream.substr(1);
  CHECK_THAT(complaint("ROSCELL_INPUTS", list), Contains("1 to 64"));
}

TEST_CASE("a parameter of the wrong type or range is named") {
  const auto p = parameters::parse(
      R"({"flag":true,"count":3,"rate":0.5,"text":"x","list":[1],"minus":-1})");
  CHECK(p.flag("flag", false));
  CHECK(p.flag("absent", true));
  CHECK(p.count("count", 0, 1, 3) == 3);
  CHECK(p.number("rate", 0, 0, 1) == 0.5);
  CHECK(p.number("count", 0, 0, 10) == 3.0);
  CHECK(p.text("text", "") == "x");
  CHECK_THROWS_WITH(p.flag("count", false),
                    Contains("parameter 'count' must be true or false")
                        && Contains("but is 3"));
  CHECK_THROWS_WITH(p.count("count", 0, 1, 2), Contains("from 1 to 2"));
  CHECK_THROWS_WITH(p.count("minus", 0, 0, 2), Contains("'minus'"));
  CHECK_THROWS_WITH(p.count("rate", 0, 0, 2), Contains("whole number"));
  CHECK_THROWS_WITH(p.number("text", 0, 0, 1), Contains("'text'"));
  CHECK_THROWS_WITH(p.text("list", ""), Contains("must be a text"));
}

TEST_CASE("a parameter may be a list, or anything that JSON can say") {
  const auto p = parameters::parse(
      R"({"lens":[0.5,-1],"families":["a","b"],"deep":{"x":[1]}})");
  CHECK(p.numbers("lens", {}, 2) == std::vector<double>{0.5, -1});
  CHECK(p.numbers("absent", {7}, 2) == std::vector<double>{7});
  CHECK(p.texts("families", {}, 2) == std::vector<std::string>{"a", "b"});
  CHECK(p.texts("absent", {"c"}, 2) == std::vector<std::string>{"c"});
  CHECK(p.has("deep"));
  CHECK_FALSE(p.has("absent"));
  CHECK(p.json("deep") == R"({"x":[1]})");
  CHECK(p.json("absent").empty());
  CHECK_THROWS_WITH(p.numbers("lens", {}, 1), Contains("at most 1 numbers"));
  CHECK_THROWS_WITH(p.numbers("families", {}, 2), Contains("'families'"));
  CHECK_THROWS_WITH(p.texts("deep", {}, 2), Contains("but is {"));
}

TEST_CASE("parameters are a JSON object") {
  for (const auto* wrong : {"", "[1]", "7", "{\"a\": "})
    CHECK_THROWS_AS(parameters::parse(wrong), start_error);
}
