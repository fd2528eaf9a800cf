#include "actors/instances/skills/skill_catalogue.hpp"

#include "test/actors/fakes/supervision_fakes.hpp"
#include "test/places.hpp"

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

/// A folder that is a skill.
void write_echo(const temp_folder& folder, const std::string& name) {
  folder.write(name + "/skill.json", echo_descriptor());
  folder.write(name + "/bin/echo", "#!/bin/sh\n", true);
}

skill_catalogue scan(const temp_folder& folder) {
  return skill_catalogue::scan({folder.path()});
}

} // namespace

TEST_CASE("a folder with a valid descriptor is a skill, found by its hash") {
  const echo_catalogue echo;
  const auto found = echo.skills->find(echo.hash);
  REQUIRE(found != nullptr);
  CHECK(found->path == echo.folder.path() / "echo");
  CHECK(found->skill.descriptor.operation == "echo");
  CHECK(echo.skills->find("") == nullptr);
  CHECK(echo.skills->problems().empty());
}

TEST_CASE("a folder without a descriptor is none of our business") {
  temp_folder folder;
  folder.write("notes/readme.txt", "no skill");
  folder.write("skill.json", echo_descriptor());
  const auto skills = scan(folder);
  CHECK(skills.skills().empty());
  CHECK(skills.problems().empty());
}

TEST_CASE("a bad descriptor is left out alone, with file and pointer") {
  temp_folder folder;
  write_echo(folder, "good");
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

TEST_CASE("a descriptor in YAML, with comments, is a skill like any other") {
  temp_folder folder;
  const auto* const name = GENERATE("skill.yaml", "skill.yml");
  folder.write(std::string{"echo/"} + name,
               "# What it does.\n" + echo_descriptor());
  folder.write("echo/bin/echo", "#!/bin/sh\n", true);
  const auto skills = scan(folder);
  CHECK(skills.problems().empty());
  REQUIRE(skills.skills().size() == 1);
  CHECK(skills.skills()[0].descriptor.operation == "echo");
}

TEST_CASE("an error in a descriptor is told with line and column") {
  temp_folder folder;
  folder.write("bad/skill.yaml",
               "# Its name is missing.\n" + with("\"plain\"", "7"));
  folder.write("bad/bin/echo", "#!/bin/sh\n", true);
  const auto skills = scan(folder);
  REQUIRE(skills.problems().size() == 1);
  const auto& problem = skills.problems()[0];
  CHECK(problem.path == folder.path() / "bad/skill.yaml");
  CHECK(problem.where == "/models/0/name");
  CHECK(problem.message.rfind("line ", 0) == 0);
  CHECK(problem.message.find("got the number 7") != std::string::npos);
}

TEST_CASE("a folder with two descriptors is refused: which is meant?") {
  temp_folder folder;
  write_echo(folder, "echo");
  folder.write("echo/skill.yaml", echo_descriptor());
  const auto skills = scan(folder);
  CHECK(skills.skills().empty());
  REQUIRE(skills.problems().size() == 1);
  CHECK(skills.problems()[0].message
        == "holds skill.json and skill.yaml; a skill has one descriptor: "
           "remove the others");
}

TEST_CASE("a descriptor of many errors is told of in bounded length") {
  temp_folder folder;
  std::string texts;
  for (int i = 0; i < 60; ++i)
    texts += std::string{i == 0 ? "" : ","} + "\"\"";
  folder.write("bad/skill.json", with("\"bin/echo\"", texts));
  CHECK(scan(folder).problems().size() == 20);
}

TEST_CASE("the same content elsewhere is the same skill") {
  temp_folder folder;
  write_echo(folder, "one");
  write_echo(folder, "two");
  const auto skills = scan(folder);
  CHECK(skills.skills().size() == 1);
  CHECK(skills.problems().empty());
}

TEST_CASE("a skill that cannot be hashed is left out") {
  temp_folder folder;
  write_echo(folder, "bad");
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

TEST_CASE("a skill whose program cannot be run is refused, with the remedy") {
  temp_folder folder;
  write_echo(folder, "good");
  folder.write("bad/skill.json", echo_descriptor());
  std::string remedy = "build the skill";
  SECTION("it is missing") {}
  SECTION("it is a folder") {
    fs::create_directories(folder.path() / "bad/bin/echo");
  }
  SECTION("it may not be executed") {
    folder.write("bad/bin/echo", "#!/bin/sh\n");
    remedy = "chmod +x";
  }
  const auto skills = scan(folder);
  CHECK(skills.skills().size() == 1);
  REQUIRE(skills.problems().size() == 1);
  const auto& problem = skills.problems()[0];
  CHECK(problem.path == folder.path() / "bad/skill.json");
  CHECK(problem.where == "/entry_point/0");
  CHECK(problem.message.find(remedy) != std::string::npos);
}

TEST_CASE("a program for another machine is refused, an own one tells for what "
          "it is built") {
  temp_folder folder{"see/skill.json", echo_descriptor()};
  // The header of a program, up to what says which machine it is for.
  std::string header("\177ELF\2\1\1\0\0\0\0\0\0\0\0\0\2\0", 18);
  header += std::string("\xB7\0\1\0\0\0", 6);
  folder.write("see/bin/echo", header, true);
  const auto here = skill_catalogue::scan({folder.path()}, {"arm64"});
  REQUIRE(here.skills().size() == 1);
  CHECK(here.skills()[0].architectures == std::vector<std::string>{"arm64"});
  const auto there = skill_catalogue::scan({folder.path()}, {"amd64"});
  CHECK(there.skills().empty());
  REQUIRE(there.problems().size() == 1);
  CHECK(there.problems()[0].message
        == "is built for arm64, and this node is amd64");
}

TEST_CASE("a program that no deployment is for is refused") {
  temp_folder folder{"see/skill.json",
                     with("[\"amd64\", \"arm64\"]", "[\"arm64\"]")};
  std::string header("\177ELF\2\1\1\0\0\0\0\0\0\0\0\0\2\0", 18);
  header += std::string("\x3E\0\1\0\0\0", 6);
  folder.write("see/bin/echo", header, true);
  const auto skills = skill_catalogue::scan({folder.path()}, {"amd64"});
  REQUIRE(skills.problems().size() == 1);
  CHECK(skills.problems()[0].message
        == "is built for amd64, and its deployments are for arm64");
}

TEST_CASE("a program that lacks a library is refused, with its name") {
  temp_folder folder;
  write_echo(folder, "see");
  fs::copy_file(test::lacking_program(), folder.path() / "see/bin/echo",
                fs::copy_options::overwrite_existing);
  const auto refused = scan(folder);
  CHECK(refused.skills().empty());
  REQUIRE(refused.problems().size() == 1);
  CHECK(refused.problems()[0].where == "/entry_point/0");
  CHECK(refused.problems()[0].message.find("libgone.so") != std::string::npos);
  // A deployment may know where it is.
  folder.write("see/skill.json", with("OF_DEPLOYMENT", "LD_LIBRARY_PATH"));
  CHECK(scan(folder).skills().size() == 1);
}

TEST_CASE("what starts a program must be there where it runs as a process") {
  temp_folder folder;
  folder.write("see/skill.json", echo_descriptor());
  folder.write("see/bin/echo", "#! /no/such/python -u\n", true);
  CHECK(scan(folder).skills().size() == 1);
  const auto refused =
      skill_catalogue::scan({folder.path()}, {own_architecture(), true});
  REQUIRE(refused.problems().size() == 1);
  CHECK(refused.problems()[0].message.find("/no/such/python'")
        != std::string::npos);
}

TEST_CASE("of one folder everything that is wrong is told at once") {
  temp_folder folder{"bad/skill.json",
                     with("\"cpu\": 0.1", "\"cpu\": \"much\"")};
  const auto bad =
      skill_catalogue::of_folder(folder.path() / "bad", {own_architecture()});
  REQUIRE(bad.problems().size() == 2);
  CHECK(bad.problems()[0].where == "/models/0/deployments/0/resources/cpu");
  CHECK(bad.problems()[1].where == "/entry_point/0");
  CHECK(bad.problems()[1].message.find("is missing") != std::string::npos);
  const auto none =
      skill_catalogue::of_folder(folder.path(), {own_architecture()});
  REQUIRE(none.problems().size() == 1);
  CHECK(none.problems()[0].message
        == "holds no skill.json, skill.yaml or skill.yml");
}

TEST_CASE("a version is the author's, else the sources', else the build's") {
  temp_folder folder;
  write_echo(folder, "echo");
  const auto version = [&] { return scan(folder).skills().at(0).version; };
  CHECK(version() == scan(folder).skills().at(0).hash);
  folder.write("echo/skill.version", "abc123\n");
  CHECK(version() == "abc123");
  folder.write("echo/skill.version", "two words\n");
  CHECK(version() == scan(folder).skills().at(0).hash);
  folder.write(
      "echo/skill.json",
      with("\"operation\": ", "\"version\": \"1.2\", \"operation\": "));
  CHECK(version() == "1.2");
}

TEST_CASE("a build tells when its folder changed last") {
  temp_folder folder;
  write_echo(folder, "echo");
  const auto before = scan(folder).skills().at(0).added_unix_ms;
  CHECK(before > 1'600'000'000'000);
  folder.write("echo/new", "");
  const auto after = scan(folder);
  CHECK(after.skills().at(0).added_unix_ms >= before);
}

TEST_CASE("what is told of problems to others is bounded") {
  temp_folder folder;
  for (int i = 0; i < 40; ++i)
    folder.write("bad" + std::to_string(i) + "/skill.json", "{");
  CHECK(scan(folder).published_problems().size() == 32);
}

TEST_CASE("a folder that looks as it did is not read again") {
  temp_folder folder;
  write_echo(folder, "same");
  folder.write("twin/skill.json", with("\"echo\"", "\"twin\""));
  folder.write("twin/bin/echo", "#!/bin/sh\n", true);
  const auto before = scan(folder);
  REQUIRE(before.skills().size() == 2);
  folder.write("twin/extra", "");
  const auto now = before.scan_again({folder.path()}, true);
  REQUIRE(now.skills().size() == 2);
  size_t kept = 0;
  for (const auto& x : now.skills())
    if (before.find(x.hash)) {
      ++kept;
      CHECK(x.descriptor.operation == "echo");
      // The same object: nothing was read but how the folder looks.
      CHECK(now.find(x.hash) == before.find(x.hash));
    }
  CHECK(kept == 1);
  CHECK(now.scan_again({folder.path()}, true).skills() == now.skills());
}

TEST_CASE("of two equal folders neither is read again, and either may go") {
  temp_folder folder;
  write_echo(folder, "a");
  write_echo(folder, "b");
  const auto before = scan(folder);
  REQUIRE(before.skills().size() == 1);
  const auto hash = before.skills()[0].hash;
  fs::remove_all(folder.path() / "a");
  const auto now = before.scan_again({folder.path()}, true);
  REQUIRE(now.find(hash) != nullptr);
  CHECK(now.find(hash)->path == folder.path() / "b");
}

TEST_CASE("what has gone is gone, and skills of this process stay") {
  temp_folder folder;
  write_echo(folder, "echo");
  auto before = scan(folder);
  REQUIRE(before
              .add_actor_skill(with("\"primitive\", \"entry_point\": "
                                    "[\"bin/echo\"]",
                                    "\"actor\""))
              .empty());
  fs::remove_all(folder.path() / "echo");
  const auto now = before.scan_again({folder.path()}, true);
  REQUIRE(now.skills().size() == 1);
  CHECK(now.skills()[0].descriptor.engine == "actor");
}

TEST_CASE("while somebody writes there a folder is neither read nor blamed") {
  temp_folder folder;
  write_echo(folder, "echo");
  const auto before = scan(folder);
  const auto hash = before.skills()[0].hash;
  folder.write("echo/extra", "half");
  folder.write("new/skill.json", echo_descriptor());
  const auto busy = before.scan_again({folder.path()}, false);
  CHECK(busy.find(hash) != nullptr);
  CHECK(busy.skills().size() == 1);
  CHECK(busy.problems().empty());
  const auto quiet = busy.scan_again({folder.path()}, true);
  CHECK(quiet.find(hash) == nullptr);
  CHECK(quiet.skills().size() == 1);
  REQUIRE(quiet.problems().size() == 1);
  CHECK(quiet.problems()[0].path == folder.path() / "new/skill.json");
}
