#include "actors/edge/engine/image_reference.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

const std::string some_digest = "sha256:" + std::string(64, 'a');

} // namespace

TEST_CASE("a name without a registry is of Docker's own") {
  const auto plain = parse_image_reference("debian");
  CHECK(plain.registry == "docker.io");
  CHECK(plain.repository == "library/debian");
  CHECK(plain.name == "debian");
  CHECK(plain.tag == "latest");
  const auto user = parse_image_reference("team/app:2");
  CHECK(user.registry == "docker.io");
  CHECK(user.repository == "team/app");
  CHECK(user.tag == "2");
}

TEST_CASE("a first part that can be no other name is a registry") {
  for (const auto* host :
       {"localhost", "127.0.0.1:5000", "ghcr.io", "base:80"}) {
    const auto x = parse_image_reference(std::string{host} + "/a/b:1");
    CHECK(x.registry == host);
    CHECK(x.repository == "a/b");
    CHECK(x.name == std::string{host} + "/a/b");
    CHECK(x.tag == "1");
  }
  CHECK(parse_image_reference("base:80/app").tag == "latest");
}

TEST_CASE("a digest is read beside a tag and without one") {
  const auto both = parse_image_reference("ghcr.io/app:1@" + some_digest);
  CHECK(both.name == "ghcr.io/app");
  CHECK(both.tag == "1");
  CHECK(both.digest == some_digest);
  CHECK(parse_image_reference("app@" + some_digest).tag.empty());
}

TEST_CASE("an id is in no registry") {
  CHECK(parse_image_reference(some_digest).id == some_digest);
  CHECK(parse_image_reference(some_digest).registry.empty());
  CHECK_FALSE(is_image_id("sha256:abc"));
  CHECK_FALSE(is_image_id("sha256:" + std::string(64, 'A')));
}

TEST_CASE("an image that came by its digest has a name of ours") {
  CHECK(name_in_engine("debian:1") == "debian:1");
  CHECK(name_in_engine("debian@" + some_digest)
        == "roscell-pinned:" + std::string(32, 'a'));
  CHECK(name_in_engine("debian@sha256:x") == "debian@sha256:x");
}

TEST_CASE("a name stays one part of a path") {
  CHECK(image_path("ghcr.io/a/b:1") == "ghcr.io/a/b:1");
  CHECK(image_path("a?b#c%d") == "a%3Fb%23c%25d");
}

} // namespace roscell::test
