#include "actors/instances/skill_catalogue.hpp"

#include "test/actors/fakes/supervision_fakes.hpp"

#include <algorithm>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

/// The descriptor with one part replaced.
std::string with(const std::string& part, const std::string& other) {
  auto text = echo_descriptor();
  const auto at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), other);
}

skill_catalogue scan(const scratch_folder& folder) {
  return skill_catalogue::scan({folder.path()});
}

} // namespace

TEST_CASE("a folder with a valid descriptor is a skill, found by its hash") {
  const echo_catalogue echo;
  const auto* found = echo.skills->find(echo.hash);
  REQUIRE(found != nullptr);
  CHECK(found->path == echo.folder.path() / "echo");
  CHECK(found->skill.descriptor.operation == "echo");
  CHECK(echo.skills->find("") == nullptr);
  CHECK(echo.skills->problems().empty());
}

TEST_CASE("a folder without a descriptor is none of our business") {
  scratch_folder folder;
  folder.write("notes/readme.txt", "no skill");
  folder.write("skill.json", echo_descriptor());
  const auto skills = scan(folder);
  CHECK(skills.skills().empty());
  CHECK(skills.problems().empty());
}

TEST_CASE("a bad descriptor is left out alone, with file and pointer") {
  scratch_folder folder;
  folder.write("good/skill.json", echo_descriptor());
  std::string where;
  SECTION("not JSON") {
    folder.write("bad/skill.json", "{ \"operation\": ");
  }
  SECTION("against the schema") {
    folder.write("bad/skill.json", with("\"cpu\": 0.1", "\"cpu\": \"much\""));
    where = "/models/0/deployments/0/resources/cpu";
  }
  SECTION("a program outside the folder") {
    folder.write("bad/skill.json",
                 with("bin/echo", GENERATE("../echo", "/bin/sh", "bin/")));
    where = "/entry_point/0";
  }
  SECTION("a model named twice") {
    folder.write("bad/skill.json",
                 with("} ] } ] }", "} ] }, { \"name\": \"plain\", "
                                   "\"deployments\": [ { \"name\": \"d\", "
                                   "\"base_image\": \"x\", \"architectures\": "
                                   "[\"amd64\"], \"resources\": { \"cpu\": 1, "
                                   "\"memory_mib\": 1, \"disk_mib\": 1 } } ] } "
                                   "] }"));
    where = "/models/1/name";
  }
  SECTION("nested without end") {
    folder.write("bad/skill.json", std::string(100'000, '['));
  }
  const auto skills = scan(folder);
  CHECK(skills.skills().size() == 1);
  REQUIRE(skills.problems().size() >= 1);
  const auto& problem = skills.problems()[0];
  CHECK(problem.path == folder.path() / "bad/skill.json");
  CHECK_FALSE(problem.message.empty());
  if (!where.empty())
    CHECK(problem.where == where);
}

TEST_CASE("a descriptor of many errors is told of in bounded length") {
  scratch_folder folder;
  std::string texts;
  for (int i = 0; i < 60; ++i)
    texts += std::string{i == 0 ? "" : ","} + "\"\"";
  folder.write("bad/skill.json", with("\"bin/echo\"", texts));
  CHECK(scan(folder).problems().size() == 20);
}

TEST_CASE("the same content elsewhere is the same skill") {
  scratch_folder folder;
  folder.write("one/skill.json", echo_descriptor());
  folder.write("two/skill.json", echo_descriptor());
  const auto skills = scan(folder);
  CHECK(skills.skills().size() == 1);
  CHECK(skills.problems().empty());
}

TEST_CASE("a skill that cannot be hashed is left out") {
  scratch_folder folder;
  folder.write("bad/skill.json", echo_descriptor());
  fs::create_symlink("/etc/passwd", folder.path() / "bad/model");
  const auto skills = scan(folder);
  CHECK(skills.skills().empty());
  CHECK(skills.problems().size() == 1);
}

TEST_CASE("a skill directory that cannot be read is told of") {
  const auto skills = skill_catalogue::scan({"/no/such/directory"});
  REQUIRE(skills.problems().size() == 1);
  CHECK(skills.problems()[0].path == "/no/such/directory");
}
