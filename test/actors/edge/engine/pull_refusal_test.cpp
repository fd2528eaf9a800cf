#include "actors/edge/engine/pull_refusal.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

void check_refusal(const std::string& said, const std::string& message,
                   const std::string& remedy) {
  const auto why = pull_refusal("docker", "a.io/app:1", said);
  CAPTURE(said, why.message, why.hint);
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message.find("registry 'a.io' " + message) != std::string::npos);
  CHECK(why.hint.find(remedy) != std::string::npos);
  CHECK(why.hint.find("docker pull a.io/app:1") != std::string::npos);
}

} // namespace

TEST_CASE("why an image cannot be pulled is told with registry and remedy") {
  check_refusal("Get \"https://a.io/v2/\": unauthorized: authentication "
                "required",
                "does not let this node", "docker login a.io");
  check_refusal("pull access denied for app, repository does not exist or may "
                "require 'docker login': denied: requested access to the "
                "resource is denied",
                "does not let this node", "--registry-auth FILE");
  check_refusal("toomanyrequests: You have reached your pull rate limit",
                "was asked too often (429)", "wait");
  check_refusal("manifest for a.io/app:1 not found: manifest unknown",
                "has no image", "base_image");
  check_refusal("dial tcp: lookup a.io: no such host", "cannot be reached",
                "the others of a cell");
  check_refusal("Get \"http://a.io/v2/\": net/http: request canceled "
                "(Client.Timeout exceeded while awaiting headers)",
                "cannot be reached", "the others of a cell");
  check_refusal("Head \"http://a.io/v2/x/manifests/1\": no basic auth "
                "credentials",
                "does not let this node", "docker login a.io");
  check_refusal("missing or empty Content-Type header", "does not give",
                "is it a registry?");
  check_refusal("invalid character 'g' looking for beginning of value",
                "does not give", "is it a registry?");
  check_refusal(R"({"message":"error parsing HTTP 200 response body"})",
                "does not give", "is it a registry?");
}

TEST_CASE("a registry that says nothing is named") {
  const auto why = pull_silence("podman", "a.io/app:1");
  CHECK(why.code == error_code::timeout);
  CHECK(why.message.find("registry 'a.io' has said nothing for 60 s")
        != std::string::npos);
}

} // namespace roscell::test
