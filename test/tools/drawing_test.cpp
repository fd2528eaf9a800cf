#include "tools/roscell/view/graph/drawing.hpp"

#include "test/printed_text.hpp"
#include "tools/roscell/view/graph/layers.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;
using roscell::test::widest_line;

namespace {

size_t count(const std::string& text, const std::string& part) {
  size_t result = 0;
  for (auto at = text.find(part); at != std::string::npos;
       at = text.find(part, at + part.size()))
    ++result;
  return result;
}

} // namespace

TEST_CASE("a box stands below those that it gets something from", "[tools]") {
  using sizes = std::vector<size_t>;
  CHECK(layers(3, {{0, 1}, {1, 2}, {0, 2}}) == sizes{0, 1, 2});
  CHECK(layers(2, {}) == sizes{0, 0});
  CHECK(layers(3, {{2, 1}, {1, 0}}) == sizes{2, 1, 0});
}

TEST_CASE("arrows in a circle end all the same", "[tools]") {
  using sizes = std::vector<size_t>;
  CHECK(layers(2, {{0, 1}, {1, 0}}) == sizes{0, 1});
  CHECK(layers(1, {{0, 0}}) == sizes{0});
}

TEST_CASE("boxes that hang together are one group", "[tools]") {
  using groups = std::vector<std::vector<size_t>>;
  CHECK(components(5, {{0, 3}, {3, 1}}) == groups{{0, 1, 3}, {2}, {4}});
}

TEST_CASE("an arrow leads down from box to box, with what it carries",
          "[tools]") {
  CHECK(drawing({{"camera", "10 Hz"}, {"poses"}},
                {{0, 1, {"/image  Image", "/info  Info"}}}, 80)
        == "┌────────┐\n"
           "│ camera │\n"
           "│ 10 Hz  │\n"
           "└─────┬──┘\n"
           "      │ /image  Image\n"
           "      │ /info  Info\n"
           "┌─────▼─┐\n"
           "│ poses │\n"
           "└───────┘\n");
}

TEST_CASE("no line of a drawing is wider than the terminal", "[tools]") {
  const std::vector<std::vector<std::string>> boxes(
      6, {"a step with a very long name that does not fit"});
  const std::vector<drawn_arrow> arrows{{0, 3, {"/a/topic/with/a/long/name"}},
                                        {1, 3, {}},
                                        {2, 3, {}},
                                        {3, 4, {}},
                                        {3, 5, {}},
                                        {0, 5, {}}};
  for (const size_t width : {60, 80, 120, 200}) {
    const auto text = drawing(boxes, arrows, width);
    CHECK(widest_line(text) <= width);
    CHECK(count(text, "▼") == arrows.size());
  }
}

TEST_CASE("too many boxes beside each other are not drawn", "[tools]") {
  std::vector<std::vector<std::string>> boxes(11, {"a wide enough box"});
  std::vector<drawn_arrow> arrows;
  for (size_t i = 0; i < 10; ++i)
    arrows.push_back({i, 10, {}});
  CHECK(drawing(boxes, arrows, 80).empty());
  CHECK_FALSE(drawing(boxes, arrows, 200).empty());
}

TEST_CASE("groups stand beside each other where there is room", "[tools]") {
  const std::vector<std::vector<std::string>> boxes{{"a"}, {"b"}};
  const auto beside = drawing(boxes, {}, 80);
  CHECK(count(beside, "\n") == 3);
  CHECK(count(beside, "│ a │    │ b │\n") == 1);
  CHECK(count(beside, "┌───┐") == 2);
  CHECK(count(beside, "└───┘") == 2);
  CHECK(drawing(boxes, {}, 12)
        == drawing({{"a"}}, {}, 12) + "\n" + drawing({{"b"}}, {}, 12));
}

TEST_CASE("arrows of several boxes to one meet there side by side", "[tools]") {
  const auto text =
      drawing({{"a"}, {"b"}, {"sum of both"}}, {{0, 2, {}}, {1, 2, {}}}, 80);
  CHECK(count(text, "▼") == 2);
  CHECK(widest_line(text) == 15);
}
