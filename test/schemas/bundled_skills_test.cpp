#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "test/places.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace roscell;
namespace fs = std::filesystem;

TEST_CASE("the descriptor of each bundled skill is valid, each model unique") {
  std::set<std::string> models;
  for (const auto& folder :
       fs::directory_iterator{test::source_dir() / "skills"}) {
    std::ifstream file{folder.path() / "skill.json"};
    if (!file)
      continue;
    INFO(folder.path());
    std::ostringstream text;
    text << file.rdbuf();
    auto parsed = parse_document(text.str());
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
