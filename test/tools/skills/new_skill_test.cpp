#include "tools/roscell/skills/new_skill.hpp"

#include "messages/codec/json_codec.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace roscell;
using namespace roscell::cli;

namespace {

std::string text_of(const std::vector<new_file>& files,
                    const std::string& path) {
  const auto i = std::find_if(files.begin(), files.end(),
                              [&](const auto& x) { return x.path == path; });
  REQUIRE(i != files.end());
  return i->text;
}

} // namespace

TEST_CASE("a skill's name can be part of a name in C++") {
  for (const auto* good : {"a", "pose_2d", "class"})
    CHECK(is_skill_name(good));
  for (const auto* bad : {"", "2d", "_a", "a_", "a__b", "A", "a-b", "a/b", "..",
                          "a b", "\xC3\xA4"})
    CHECK_FALSE(is_skill_name(bad));
  CHECK(is_skill_name(std::string(63, 'a')));
  CHECK_FALSE(is_skill_name(std::string(64, 'a')));
}

TEST_CASE("for a name that cannot be, the nearest one is told") {
  CHECK(skill_name_for("Pose-Estimation") == "pose_estimation");
  CHECK(skill_name_for("../my skill/") == "my_skill");
  CHECK(skill_name_for("a__b") == "a_b");
  CHECK(skill_name_for("2d").empty());
  CHECK(skill_name_for("--").empty());
}

TEST_CASE("nothing of a new skill is left for its author to fill in") {
  const auto files = skill_files("shout", "/home/you/shout");
  CHECK(files.size() == embedded_template().size());
  for (const auto& x : files) {
    INFO(x.path);
    CHECK(x.path.find("NAME") == std::string::npos);
    CHECK(x.text.find('@') == std::string::npos);
    CHECK_FALSE(x.text.empty());
  }
}

TEST_CASE("a new skill's descriptor is right") {
  const auto document =
      json::parse(text_of(skill_files("shout", "/x"), "skill.json"));
  CHECK(document.at("operation") == "shout");
  CHECK_FALSE(validate_document("skill_descriptor", document));
}

TEST_CASE("a new skill's task names its files, whatever they are called") {
  const auto text =
      text_of(skill_files("shout", "/home/a \"b\": {/shout"), "task.yaml");
  const auto parsed = parse_document(text, document_format::yaml);
  REQUIRE(std::holds_alternative<json>(parsed));
  CHECK(std::get<json>(parsed).at("pipeline").at(0).at("input")
        == "/home/a \"b\": {/shout/test/frames.txt");
}
