#include "actors/cell/tables/image_sources.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

/// Images that one node's engine has and another one's lacks.
namespace roscell::test {

namespace {

const std::string debian_id = "sha256:" + std::string(64, 'a');
const std::string other_id = "sha256:" + std::string(64, 'b');

/// Two members; `leg` lacks an image.
struct image_cell : paper_cell {
  fake_agent& arm = add("arm");
  fake_agent& leg = add("leg");

  image_cell() {
    for (auto* x : {&base, &arm, &leg})
      x->shared_build = {std::string(64, 'c'), std::string(64, 'd'), 7};
  }

  auto ask(const std::string& node = "leg") {
    auto result = time.ask<image_offered>(
        coordinator, image_request{"debian:1", "amd64", node, {}});
    time.settle();
    return result;
  }
};

} // namespace

TEST_CASE_METHOD(image_cell, "A node gets an image from one that has it",
                 "[images]") {
  arm.images["debian:1"] = debian_id;
  const auto offer = ask();
  REQUIRE(*offer);
  REQUIRE(**offer);
  CHECK((**offer)->image_id == debian_id);
  CHECK((**offer)->node == "arm");
  CHECK((**offer)->offer.build.hash == arm.shared_build.hash);
  REQUIRE((**offer)->offer.sources.size() == 1);
  CHECK((**offer)->offer.sources[0].node == "arm");
  REQUIRE(arm.sharings.size() == 1);
  CHECK(arm.sharings[0].image_id == debian_id);
  CHECK(leg.sharings.empty());
}

TEST_CASE_METHOD(image_cell,
                 "Who gets an image gives it to those who come later",
                 "[images]") {
  arm.images["debian:1"] = debian_id;
  ask();
  const auto offer = ask("base");
  REQUIRE(**offer);
  CHECK((**offer)->offer.sources.size() == 2);
}

TEST_CASE_METHOD(image_cell, "Where one node cannot save an image another does",
                 "[images]") {
  arm.images["debian:1"] = base.images["debian:1"] = debian_id;
  arm.gets_nothing = true;
  CHECK((**ask())->node == "base");
  base.gets_nothing = true;
  CHECK(to_failure((*ask())->error()).code == error_code::unreachable);
}

TEST_CASE_METHOD(image_cell, "An image that no node has is told at once",
                 "[images]") {
  const auto offer = ask();
  REQUIRE(*offer);
  CHECK(to_failure((*offer)->error()).code == error_code::conflict);
}

TEST_CASE_METHOD(image_cell, "A node that is no member gets no image",
                 "[images]") {
  arm.images["debian:1"] = debian_id;
  CHECK(to_failure((*ask("nobody"))->error()).code == error_code::unknown_node);
  lose(arm);
  CHECK(to_failure((*ask())->error()).code == error_code::conflict);
}

TEST_CASE("all who ask for an image are given the same one", "[images]") {
  const image_holders holders{
      {"a", other_id}, {"b", debian_id}, {"c", debian_id}, {"d", ""}};
  const auto choice = choose_image(holders, {});
  CHECK(choice.image_id == debian_id);
  CHECK(choice.nodes == std::vector<std::string>{"b", "c"});
  CHECK(choose_image(holders, {"c"}).nodes
        == std::vector<std::string>{"c", "b"});
  CHECK(choose_image({{"a", other_id}, {"b", debian_id}}, {}).image_id
        == debian_id);
  CHECK(choose_image({{"a", ""}}, {}).nodes.empty());
}

TEST_CASE("the builds of images that came last are remembered", "[images]") {
  image_readers table;
  for (int i = 0; i < 100; ++i)
    table.add_source(debian_id, std::to_string(i), "arm");
  CHECK(table.of_build("0").empty());
  CHECK(table.of_build("99") == std::vector<std::string>{"arm"});
  table.add_reader("99", "leg");
  table.add_reader("none", "leg");
  CHECK(table.of_build("99").size() == 2);
  CHECK(table.givers_of(debian_id) == std::set<std::string>{"arm"});
  CHECK(table.givers_of(other_id).empty());
}

} // namespace roscell::test
