#include "test/skills/child_process.hpp"

#include "test/places.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace roscell::test;
using Catch::Matchers::EndsWith;

namespace {

/// Runs the tool on definitions of a package of its own.
class tool_run {
public:
  tool_run& define(const std::string& name, const std::string& text) {
    auto path = folder_ / "my_msgs/msg/" + name;
    std::filesystem::create_directories(folder_ / "my_msgs/msg");
    folder_.write("my_msgs/msg/" + name, text);
    files_.push_back(path);
    return *this;
  }

  /// What it says, without the folder; empty when it made the structs.
  std::string problem() {
    std::vector<std::string> command{roscell::test::python(), "-B",
                                     roscell::test::source_dir()
                                         / "tools/generate_messages",
                                     "--to", folder_ / "made"};
    command.insert(command.end(), files_.begin(), files_.end());
    child_process tool{command, {}};
    auto code = tool.wait();
    auto said = tool.output();
    CHECK((code == 0) == said.empty());
    // Half a header would be taken for a whole one.
    CHECK(std::filesystem::exists(folder_ / "made") == said.empty());
    auto at = said.find("my_msgs/msg/");
    return at == std::string::npos ? said : said.substr(at);
  }

private:
  temp_folder folder_;
  std::vector<std::string> files_;
};

/// What is wrong with a definition whose second line is this one.
std::string problem_of(const std::string& line) {
  auto said =
      tool_run{}.define("A.msg", "# A comment.\n" + line + "\n").problem();
  const std::string place = "my_msgs/msg/A.msg:2: ";
  return said.rfind(place, 0) == 0 ? said.substr(place.size()) : said;
}

} // namespace

TEST_CASE("a definition with nothing wrong is said nothing of") {
  CHECK(problem_of("int32 x").empty());
  CHECK(problem_of("float64[<=3] x [1, 2.5]  # metres").empty());
}

TEST_CASE("a wrong line of a definition is refused with file and line") {
  CHECK(problem_of("int33 x") == "'int33' is no type\n");
  CHECK(problem_of("int32[-1] x") == "'int32[-1]' is no type\n");
  CHECK(problem_of("int32[0] x") == "an array of nothing: 'int32[0]'\n");
  CHECK(problem_of("int32<=4 x") == "only a string has a length: 'int32<=4'\n");
  CHECK(problem_of("wstring x")
        == "wstring is not supported: DDS implementations write it "
           "differently; take string, which is UTF-8\n");
  for (const char* name : {"", "X", "_x", "x_", "x__y", "x-y"})
    CHECK(problem_of(std::string{"int32 "} + name)
          == "'" + std::string{name}
                 + "' is no name of a field: lower case, digits and single "
                   "underscores\n");
  CHECK(problem_of("int32 x\nint32 x").find("A.msg:3: 'x' is there twice")
        != std::string::npos);
}

TEST_CASE("a value that its type cannot hold is refused") {
  for (const char* line :
       {"uint8 x 256", "uint8 x -1", "int8 X = 128", "bool x 2", "int32 x 1.5",
        "float32 x inf", "float64 x one", "string x \"open", "int32[2] x [1]",
        "int32[<=1] x [1, 2]", "int32[] x 1", "uint8[] x [1, 300]"}) {
    INFO(line);
    CHECK_THAT(problem_of(line), EndsWith("is no value of this type\n"));
  }
  CHECK(problem_of("int32[] X = [1]")
        == "a constant is a number, a truth value or a string\n");
}

TEST_CASE("a type that no definition describes is refused where it is used") {
  CHECK(problem_of("B b") == "there is no definition of my_msgs/B\n");
  CHECK(problem_of("other_msgs/B b")
        == "there is no definition of other_msgs/B\n");
}

TEST_CASE("messages may be written in any order, but none contains itself") {
  CHECK(tool_run{}
            .define("A.msg", "B[] b\n")
            .define("B.msg", "int32 x\n")
            .problem()
            .empty());
  CHECK(tool_run{}
            .define("A.msg", "B b\n")
            .define("B.msg", "int32 x\nA[] a\n")
            .problem()
        == "my_msgs/msg/B.msg:2: my_msgs/A would contain itself\n");
}

TEST_CASE("a file that is no definition of a package is refused") {
  CHECK_THAT(tool_run{}.define("lower.msg", "").problem(),
             EndsWith("a definition lies in PACKAGE/msg/TYPE.msg\n"));
  CHECK_THAT(tool_run{}.define("A.msg", "# \xff\n").problem(),
             Catch::StartsWith("my_msgs/msg/A.msg: cannot be read: "));
}
