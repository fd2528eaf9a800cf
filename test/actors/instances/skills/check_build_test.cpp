#include "actors/instances/skills/skill_program.hpp"

#include "test/actors/fakes/supervision_fakes.hpp"

#include <variant>

using namespace roscell;
using namespace roscell::test;

namespace {

/// The build of the echo skill, as its catalogue has read it.
prepare_image image_request_of(const echo_catalogue& echo) {
  const auto& folder = *echo.skills->find(echo.hash);
  prepare_image request;
  request.skill_dir = folder.path.string();
  request.skill = echo.hash;
  request.look = folder.look;
  return request;
}

bool is_same(const prepare_image& request) {
  return std::holds_alternative<bool>(check_build(request));
}

} // namespace

TEST_CASE("a folder that was not touched holds its build") {
  const echo_catalogue echo;
  CHECK(is_same(image_request_of(echo)));
}

TEST_CASE("an edited folder does not run under the hash that it had") {
  const echo_catalogue echo;
  const auto request = image_request_of(echo);
  SECTION("a program that was replaced") {
    echo.folder.write("echo/bin/echo", "#!/bin/sh\nexit 1\n", true);
  }
  SECTION("of the same length") {
    echo.folder.write("echo/bin/echo", "#!/bin/ls\n", true);
  }
  SECTION("a file more") {
    echo.folder.write("echo/model", "");
  }
  SECTION("a file less") {
    std::filesystem::remove(echo.folder.path() / "echo/bin/echo");
  }
  const auto result = check_build(request);
  REQUIRE(std::holds_alternative<edge_error>(result));
  const auto& why = std::get<edge_error>(result);
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("was edited") != std::string::npos);
  CHECK(why.hint.find("build of its own") != std::string::npos);
}

TEST_CASE("a folder that only looks otherwise still holds its build") {
  const echo_catalogue echo;
  auto request = image_request_of(echo);
  echo.folder.write("echo/bin/echo", "#!/bin/sh\n", true);
  CHECK(is_same(request));
  request.look = "nothing like it";
  CHECK(is_same(request));
}
