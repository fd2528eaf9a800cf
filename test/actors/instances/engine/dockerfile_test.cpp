#include "actors/instances/engine/dockerfile.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

image_recipe echo_recipe() {
  return {"echo",
          "0123abcd",
          "debian:bookworm-slim",
          {"bin/echo", "an \"argument\""},
          {{"libz.so.1", "/usr/lib/libz.so.1.2.13", 121280, 1700000000}}};
}

} // namespace

TEST_CASE("a Dockerfile is base image, libraries, skill and entry point") {
  CHECK(dockerfile_of(echo_recipe())
        == "FROM debian:bookworm-slim\n"
           "# \"libz.so.1\" is \"/usr/lib/libz.so.1.2.13\", 121280 bytes of "
           "1700000000\n"
           "COPY opt /opt\n"
           "ENV LD_LIBRARY_PATH=/opt/roscell/lib\n"
           "WORKDIR /opt/roscell/skill\n"
           "LABEL roscell.skill=0123abcd\n"
           "ENTRYPOINT [\"/opt/roscell/skill/bin/echo\","
           "\"an \\\"argument\\\"\"]\n");
}

TEST_CASE("without libraries nothing is said of them") {
  auto recipe = echo_recipe();
  recipe.libraries.clear();
  CHECK(dockerfile_of(recipe).find("LD_LIBRARY_PATH") == std::string::npos);
}

TEST_CASE("no name can add an instruction to a Dockerfile") {
  auto recipe = echo_recipe();
  recipe.entry_point = {"bin/a\nRUN b", "\xff\nRUN c"};
  recipe.libraries[0].file = "/lib/x\nRUN d";
  const auto text = dockerfile_of(recipe);
  CHECK(text.find("\nRUN") == std::string::npos);
}

TEST_CASE("an image is named by the operation and all that goes into it") {
  const auto name = image_name("echo", dockerfile_of(echo_recipe()));
  CHECK(name.size() == std::string{"roscell/echo:"}.size() + 32);
  CHECK(name.rfind("roscell/echo:", 0) == 0);
  CHECK(name == image_name("echo", dockerfile_of(echo_recipe())));
  auto changed = echo_recipe();
  SECTION("another skill") {
    changed.skill = "4567";
  }
  SECTION("another base image") {
    changed.base_image = "debian:trixie";
  }
  SECTION("another entry point") {
    changed.entry_point.pop_back();
  }
  SECTION("a newer library") {
    ++changed.libraries[0].modified_unix_s;
  }
  CHECK(name != image_name("echo", dockerfile_of(changed)));
}

TEST_CASE("an operation's name becomes one that images can have") {
  const auto repository = [](const std::string& operation) {
    const auto name = image_name(operation, "");
    return name.substr(0, name.find(':'));
  };
  CHECK(repository("pose_estimation") == "roscell/pose_estimation");
  CHECK(repository("Detect-2.Fast") == "roscell/detect_2_fast");
  CHECK(repository("__a__b__") == "roscell/a_b");
  CHECK(repository("---") == "roscell/skill");
}
