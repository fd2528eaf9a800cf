#include "actors/cell/tables/cell_builds.hpp"

#include "actors/cell/limits.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

namespace {

cell_build build_of(const std::string& hash, const std::string& operation,
                    const std::string& version,
                    const std::vector<std::string>& architectures = {"amd64"}) {
  cell_build result;
  result.build.hash = result.skill.hash = hash;
  result.skill.descriptor.operation = operation;
  result.skill.version = version;
  result.skill.architectures = architectures;
  return result;
}

} // namespace

TEST_CASE("one version of a skill has one build for an architecture",
          "[builds]") {
  cell_builds builds;
  builds.add(build_of("a", "shout", "1.0"));
  CHECK(builds.refusal(build_of("b", "shout", "1.0"))->code
        == error_code::conflict);
  CHECK(builds.refusal(build_of("b", "shout", "1.0", {})));
  CHECK_FALSE(builds.refusal(build_of("b", "shout", "1.1")));
  CHECK_FALSE(builds.refusal(build_of("b", "whisper", "1.0")));
  CHECK_FALSE(builds.refusal(build_of("b", "shout", "1.0", {"arm64"})));
  CHECK_FALSE(builds.refusal(build_of("a", "shout", "1.0")));
}

TEST_CASE("a cell has so many builds and no more", "[builds]") {
  cell_builds builds;
  for (size_t i = 0; i < limits::build::of_cell; ++i) {
    const auto x = build_of(std::to_string(i), "shout", std::to_string(i));
    REQUIRE_FALSE(builds.refusal(x));
    builds.add(x);
  }
  CHECK(builds.refusal(build_of("x", "shout", "x")));
  builds.remove({"0", {}, 0});
  CHECK_FALSE(builds.refusal(build_of("x", "shout", "x")));
}

TEST_CASE("builds are listed by operation, the newest first", "[builds]") {
  cell_builds builds;
  auto old = build_of("a", "shout", "1");
  old.added_unix_ms = 1;
  auto fresh = build_of("b", "shout", "2");
  fresh.added_unix_ms = 2;
  builds.add(old);
  builds.add(fresh);
  builds.add(build_of("c", "echo", "1"));
  REQUIRE(builds.of("").size() == 3);
  CHECK(builds.of("")[0].build.hash == "c");
  CHECK(builds.of("shout")[0].build.hash == "b");
}

TEST_CASE("what was removed remains until the last node has let it go",
          "[builds]") {
  cell_builds builds;
  builds.add(build_of("a", "shout", "1"));
  builds.remove({"a", {"arm", "leg"}, 1});
  CHECK_FALSE(builds.find("a"));
  CHECK(builds.remains_on("arm") == std::vector<std::string>{"a"});
  CHECK(builds.remains_on("head").empty());
  CHECK_FALSE(builds.release("a", "arm"));
  CHECK(builds.remains_on("arm").empty());
  CHECK(builds.release("a", "leg"));
  CHECK_FALSE(builds.find_remains("a"));
}

TEST_CASE("what is added again may stay where it was", "[builds]") {
  cell_builds builds;
  builds.add(build_of("a", "shout", "1"));
  builds.remove({"a", {"arm"}, 1});
  builds.add(build_of("a", "shout", "1"));
  CHECK(builds.remains_on("arm").empty());
}

TEST_CASE("of remains the oldest are forgotten first", "[builds]") {
  cell_builds builds;
  const auto most = static_cast<int64_t>(limits::build::remains);
  for (int64_t i = 0; i <= most; ++i)
    builds.restore({std::to_string(i), {"arm"}, i});
  CHECK_FALSE(builds.find_remains("0"));
  CHECK(builds.find_remains("1"));
  CHECK(builds.find_remains(std::to_string(most)));
}

TEST_CASE("a build runs where its architecture is, a script everywhere",
          "[builds]") {
  CHECK(runs_on_architecture(build_of("a", "x", "1").skill, "amd64"));
  CHECK_FALSE(runs_on_architecture(build_of("a", "x", "1").skill, "arm64"));
  CHECK(runs_on_architecture(build_of("a", "x", "1", {}).skill, "arm64"));
}
