#include "actors/edge/http/http_target.hpp"

#include <catch2/catch.hpp>

namespace roscell {

TEST_CASE("a target is a path and a query, both decoded") {
  const auto target = parse_target("/v1/logs/a%2Fb+c?follow=1&k=a%26b&&x=");
  REQUIRE(target);
  CHECK(target->path == "/v1/logs/a/b+c");
  CHECK(target->query
        == std::map<std::string, std::string>{
            {"follow", "1"}, {"k", "a&b"}, {"x", ""}});
  CHECK(parse_target("/")->query.empty());
  CHECK(parse_target("/?")->query.empty());
  CHECK(parse_target("/?a=1&a=2")->query.at("a") == "2");
}

TEST_CASE("a malformed target is none") {
  for (const auto* text : {"", "x", "*", "http://host/", "/%", "/%4", "/%zz",
                           "/%00", "/a%0d%0ab", "/?a=%", "/?%=1", "/\x7f"})
    CHECK_FALSE(parse_target(text));
}

TEST_CASE("an encoded text is decoded to itself") {
  const std::string text = "a/b c?&=%+ü~-._";
  const auto encoded = percent_encode(text);
  CHECK(encoded == "a%2Fb%20c%3F%26%3D%25%2B%C3%BC~-._");
  CHECK(parse_target("/" + encoded)->path == "/" + text);
}

} // namespace roscell
