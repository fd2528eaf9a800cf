#include "actors/edge/engine/image_cleaning.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

namespace roscell::test {

namespace {

using document = nlohmann::json;

std::vector<built_image> three_images() {
  return {{"roscell/b:1", "b", 30},
          {"roscell/a:1", "a", 10},
          {"roscell/c:1", "c", 20}};
}

} // namespace

TEST_CASE("the oldest images that nobody has are removed first") {
  using names = std::vector<std::string>;
  CHECK(images_to_remove(three_images(), {}, {}, 1)
        == names{"roscell/a:1", "roscell/c:1"});
  CHECK(images_to_remove(three_images(), {}, {}, 3).empty());
  CHECK(images_to_remove(three_images(), {}, {}, 0).size() == 3);
}

TEST_CASE("an image of a container or an instance is never removed") {
  using names = std::vector<std::string>;
  CHECK(images_to_remove(three_images(), {"a"}, {}, 0)
        == names{"roscell/c:1", "roscell/b:1"});
  CHECK(images_to_remove(three_images(), {"a"}, {"roscell/c:1"}, 0)
        == names{"roscell/b:1"});
}

TEST_CASE("only what we have built counts, by whatever name it is listed") {
  const auto images = document::parse(R"([
    {"Id": "sha256:1", "RepoTags": ["roscell/echo:x", "mine:1"], "Created": 5},
    {"Id": "2", "RepoTags": ["docker.io/roscell/echo:y"]},
    {"Id": "3", "RepoTags": ["debian:latest", "roscell-pinned:z"]},
    {"Id": "4", "RepoTags": null}, 7])");
  const auto found = built_images_in(images);
  REQUIRE(found.size() == 2);
  CHECK(found[0].name == "roscell/echo:x");
  CHECK(found[0].id == "1");
  CHECK(found[0].created_unix_s == 5);
  CHECK(found[1].name == "roscell/echo:y");
  CHECK(built_images_in(document{{"a", 1}}).empty());
}

TEST_CASE("the images of all containers are in use") {
  const auto containers =
      document::parse(R"([{"ImageID": "sha256:1"}, {"ImageID": "2"}, 7])");
  CHECK(used_images_in(containers).count("1") == 1);
  CHECK(used_images_in(containers).count("2") == 1);
}

} // namespace roscell::test
