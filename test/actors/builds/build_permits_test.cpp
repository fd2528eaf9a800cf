#include "actors/builds/build_permits.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("a permit is for one build, one node and one giver", "[builds]") {
  const std::string hash(64, 'a');
  const std::string other(64, 'b');
  build_permits permits;
  permits.use_key("key");
  const auto permit = build_permits::sign("key", hash, "10.0.0.3");
  const auto path = "/v1/builds/" + hash;
  CHECK(permits.allows(path, permit, "10.0.0.3"));
  CHECK(permits.allows(path + "/manifest", permit, "10.0.0.3"));
  CHECK(permits.allows(path + "/pieces/3", permit, "10.0.0.3"));
  CHECK_FALSE(permits.allows(path, permit, "10.0.0.4"));
  CHECK_FALSE(permits.allows("/v1/builds/" + other, permit, "10.0.0.3"));
  CHECK_FALSE(permits.allows("/v1/node", permit, "10.0.0.3"));
  CHECK_FALSE(permits.allows(path, "", "10.0.0.3"));
  CHECK_FALSE(permits.allows(
      path, build_permits::sign("another key", hash, "10.0.0.3"), "10.0.0.3"));
}

TEST_CASE("without a key nobody is served", "[builds]") {
  const std::string hash(64, 'a');
  build_permits permits;
  const auto permit = build_permits::sign("", hash, "10.0.0.3");
  CHECK_FALSE(permits.allows("/v1/builds/" + hash, permit, "10.0.0.3"));
}
