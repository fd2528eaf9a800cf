#include "tools/roscell/top/layout/listing.hpp"

#include "tools/roscell/top/layout/listing_lines.hpp"
#include "tools/roscell/view/format.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;
using namespace roscell::cli::top;

namespace {

std::string bar_text(const share& of, size_t width, bool utf8) {
  line x;
  x.spans = bar(of, width, utf8);
  return text_of(x);
}

listing three() {
  listing result;
  result.columns = {{"NAME"}, {"RATE", align::right, 1}};
  result.items = {{"b", {{"b"}, {"9.5 Hz"}}, {}},
                  {"a", {{"a"}, {"29.9 Hz"}}, {}},
                  {"c", {{"c"}, {""}}, {}}};
  return result;
}

std::string ids(const listing& x) {
  std::string result;
  for (const auto& i : x.items)
    result += i.id;
  return result;
}

listing many(size_t count) {
  listing result;
  result.columns = {{"NAME"}};
  for (size_t i = 0; i < count; ++i) {
    const auto name = "n" + std::to_string(100 + i);
    result.items.push_back({name, {{name}}, {}});
  }
  return result;
}

} // namespace

TEST_CASE("a bar tells others, instances and what is free by characters",
          "[top]") {
  CHECK(bar_text({2, 1, 4}, 8, false) == "####++..");
  CHECK(bar_text({2, 1, 4}, 8, true) == "████▒▒··");
  CHECK(bar_text({0, 0, 4}, 4, false) == "....");
}

TEST_CASE("a bar shows the least amount, and never more than its width",
          "[top]") {
  CHECK(bar_text({0.001, 0.001, 100}, 5, false) == "#+...");
  CHECK(bar_text({9, 9, 10}, 5, false) == "+++++");
  CHECK(bar_text({9, 1, 5}, 5, false) == "####+");
  CHECK(bar_text({1, 1, 0}, 3, false) == "...");
  CHECK(bar_text({1, 1, 4}, 0, false).empty());
}

TEST_CASE("a list is sorted by numbers, and nothing known is last", "[top]") {
  CHECK(ids(chosen(three(), "", {0, false})) == "abc");
  CHECK(ids(chosen(three(), "", {0, true})) == "cba");
  CHECK(ids(chosen(three(), "", {1, false})) == "bac");
  CHECK(ids(chosen(three(), "", {1, true})) == "abc");
}

TEST_CASE("a filter is looked for in all cells, in any case", "[top]") {
  CHECK(ids(chosen(three(), "HZ", {0, false})) == "ab");
  CHECK(ids(chosen(three(), "29.9", {0, false})) == "a");
  CHECK(ids(chosen(three(), "x", {0, false})).empty());
}

TEST_CASE("a column is named as in the tables", "[top]") {
  CHECK(column_of(three(), "rate") == 1u);
  CHECK_FALSE(column_of(three(), "nothing"));
}

TEST_CASE("the selected thing is among the lines that there is room for",
          "[top]") {
  listing_style style;
  style.height = 6;
  style.focused = true;
  for (const auto* selected : {"n100", "n150", "n199"}) {
    style.selected = selected;
    const auto lines = listing_lines(many(100), style);
    REQUIRE(lines.size() == 6);
    size_t marked = 0;
    for (const auto& x : lines)
      if (x.selected) {
        ++marked;
        CHECK(text_of(x).substr(0, 5) == ">" + std::string{selected});
      }
    CHECK(marked == 1);
  }
}

TEST_CASE("no line is wider than the screen, whatever its width", "[top]") {
  auto x = many(3);
  x.columns.push_back({"CPU", align::left, 1});
  x.columns.push_back({"REASON", align::left, 2});
  for (auto& i : x.items) {
    i.cells.push_back({" 50%", look::plain, share{1, 1, 4}, "2/4"});
    i.cells.push_back({std::string(200, 'x')});
    i.below = {{{"gpu 0"}, {" 25%", look::plain, share{1, 0, 4}, "1/4 GiB"}}};
  }
  for (size_t width = 0; width < 140; ++width) {
    listing_style style;
    style.width = width;
    for (const auto& line : listing_lines(x, style))
      CHECK(width_of(line) <= width);
  }
}

TEST_CASE("room that is left over makes bars longer, with exact numbers",
          "[top]") {
  listing x;
  x.columns = {{"NODE"}, {"CPU", align::left, 1}};
  x.items = {
      {"arm", {{"arm"}, {" 50%", look::plain, share{1, 1, 4}, "2/4"}}, {}}};
  listing_style style;
  style.utf8 = false;
  style.width = 24;
  CHECK(text_of(listing_lines(x, style)[1]).find("##++") != std::string::npos);
  style.width = 60;
  const auto text = text_of(listing_lines(x, style)[1]);
  CHECK(text.find("########") != std::string::npos);
  CHECK(text.find("2/4") != std::string::npos);
}

TEST_CASE("no room is no lines", "[top]") {
  listing_style style;
  style.height = 0;
  CHECK(listing_lines(three(), style).empty());
}
