#include "actors/edge/engine/registry_login.hpp"
#include "schemas/utf8.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace roscell::test {

namespace fs = std::filesystem;

namespace {

using document = nlohmann::json;

document decoded(std::string header) {
  std::replace(header.begin(), header.end(), '-', '+');
  std::replace(header.begin(), header.end(), '_', '/');
  return document::parse(from_base64(header).value_or(""), nullptr, false);
}

document login_entry_of(const std::string& user, const std::string& password) {
  return {{"auth", to_base64(user + ":" + password)}};
}

std::string user_in(const document& file, const std::string& registry,
                    const std::string& repository = "app") {
  const auto found = read_login(file, registry, repository);
  return found.login ? found.login->user : "";
}

/// Logins of a user, and where helpers are.
struct login_bench {
  login_places places(const document& file) const {
    login_places result;
    result.files = {folder / "none.json",
                    folder.write("config.json", file.dump())};
    result.environment = {{"PATH", (folder / "bin") + ":/usr/bin:/bin"}};
    return result;
  }

  void add_helper(const std::string& script) const {
    folder.write("bin/docker-credential-trial", "#!/bin/sh\n" + script, true);
  }

  temp_folder folder;
};

} // namespace

TEST_CASE("a login is found by the name of its registry") {
  const document file{
      {"auths",
       {{"ghcr.io", login_entry_of("one", "p")},
        {"https://127.0.0.1:5000/v2/", login_entry_of("two", "p:q")},
        {"https://index.docker.io/v1/", login_entry_of("three", "p")},
        {"quay.io/team", login_entry_of("four", "p")},
        {"quay.io", login_entry_of("five", "p")}}}};
  CHECK(user_in(file, "ghcr.io") == "one");
  CHECK(user_in(file, "127.0.0.1:5000") == "two");
  CHECK(user_in(file, "docker.io", "library/debian") == "three");
  CHECK(user_in(file, "quay.io", "team/app") == "four");
  CHECK(user_in(file, "quay.io", "other/app") == "five");
  CHECK(user_in(file, "other.io").empty());
  CHECK(read_login(file, "127.0.0.1:5000", "x").login->password == "p:q");
}

TEST_CASE("a file of logins that makes no sense has none") {
  for (const auto* text :
       {"{}", "[]", "7", R"({"auths":7})", R"({"auths":{"a.io":7}})",
        R"({"auths":{"a.io":{"auth":"?"}}})",
        R"({"auths":{"a.io":{"auth":7}},"credsStore":7,"credHelpers":[]})"}) {
    const auto found = read_login(document::parse(text), "a.io", "x");
    CHECK(!found.login);
    CHECK(found.helper.empty());
  }
}

TEST_CASE("a registry's own helper goes before that of all") {
  const document file{{"credsStore", "all"},
                      {"credHelpers", {{"a.io", "own"}}}};
  CHECK(read_login(file, "a.io", "x").helper == "own");
  CHECK(read_login(file, "b.io", "x").helper == "all");
}

TEST_CASE("an engine is told of a login as it wants it") {
  const auto known = decoded(login_header({"me", "s/e+c?", ""}, "docker.io"));
  CHECK(known.at("username") == "me");
  CHECK(known.at("password") == "s/e+c?");
  CHECK(known.at("serveraddress") == "https://index.docker.io/v1/");
  const auto token = decoded(login_header({"", "", "t"}, "a.io"));
  CHECK(token.at("identitytoken") == "t");
  CHECK(token.count("password") == 0);
}

TEST_CASE("a helper is asked for a registry by its input") {
  const login_bench b;
  b.add_helper("read -r host\n[ \"$1\" = get ] && printf "
               "'{\"ServerURL\":\"%s\",\"Username\":\"u\",\"Secret\":\"%s\"}' "
               "\"$host\" \"$host-s\"\n");
  const auto found =
      find_login_header("a.io/app:1", b.places({{"credsStore", "trial"}}));
  const auto header = decoded(std::get<std::string>(found));
  CHECK(header.at("username") == "u");
  CHECK(header.at("password") == "a.io-s");
}

TEST_CASE("a helper that knows no login leaves a registry without one") {
  const login_bench b;
  b.add_helper("echo 'credentials not found in native keychain'; exit 1\n");
  const auto found =
      find_login_header("a.io/app:1", b.places({{"credsStore", "trial"}}));
  CHECK(std::get<std::string>(found).empty());
}

TEST_CASE("a helper that fails is named, and no secret with it") {
  const login_bench b;
  b.add_helper("echo 'secret-word'; exit 3\n");
  const auto found =
      find_login_header("a.io/app:1", b.places({{"credsStore", "trial"}}));
  const auto& why = std::get<edge_error>(found);
  CHECK(why.code == error_code::unauthorized);
  CHECK(why.message.find("docker-credential-trial") != std::string::npos);
  CHECK(why.message.find("a.io") != std::string::npos);
  CHECK(why.message.find("secret-word") == std::string::npos);
}

TEST_CASE("a helper's name is no other program's") {
  const login_bench b;
  for (const auto* name : {"../evil", "a b", "a;b"}) {
    const auto found =
        find_login_header("a.io/x", b.places({{"credsStore", name}}));
    CHECK(std::holds_alternative<edge_error>(found));
  }
}

TEST_CASE("a node's own file of logins is one that others may not read") {
  const login_bench b;
  auto places = b.places({{"auths", {{"a.io", login_entry_of("user", "p")}}}});
  places.own = b.folder.write(
      "own.json",
      document{{"auths", {{"a.io", login_entry_of("node", "p")}}}}.dump());
  fs::permissions(places.own, fs::perms::owner_read | fs::perms::group_read);
  const auto open = find_login_header("a.io/x", places);
  CHECK(std::get<edge_error>(open).hint.find("chmod 600") != std::string::npos);
  fs::permissions(places.own, fs::perms::owner_read);
  const auto closed = find_login_header("a.io/x", places);
  CHECK(decoded(std::get<std::string>(closed)).at("username") == "node");
}

TEST_CASE("a file of logins that is broken is named") {
  const login_bench b;
  login_places places;
  places.files = {b.folder.write("config.json", "{")};
  const auto found = find_login_header("a.io/x", places);
  CHECK(std::get<edge_error>(found).message.find("config.json")
        != std::string::npos);
}

} // namespace roscell::test
