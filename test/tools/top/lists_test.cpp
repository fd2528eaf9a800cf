#include "tools/roscell/top/layout/lists.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using namespace roscell::cli::top;

namespace {

table three() {
  return {{{"NAME"}, {"RATE", align::right, 1}},
          {{"b", "9.5 Hz"}, {"a", "29.9 Hz"}, {"c", ""}}};
}

std::string names(const table& x) {
  std::string result;
  for (const auto& row : x.rows)
    result += row.front().text;
  return result;
}

table many(size_t count) {
  table result{{{"NAME"}}, {}};
  for (size_t i = 0; i < count; ++i)
    result.rows.push_back({"n" + std::to_string(100 + i)});
  return result;
}

} // namespace

TEST_CASE("a list is sorted by numbers, and nothing known is last", "[top]") {
  CHECK(names(ordered(three(), "", {"", false})) == "abc");
  CHECK(names(ordered(three(), "", {"NAME", true})) == "cba");
  CHECK(names(ordered(three(), "", {"RATE", false})) == "bac");
  CHECK(names(ordered(three(), "", {"RATE", true})) == "abc");
}

TEST_CASE("the selected thing is among the lines that there is room for",
          "[top]") {
  list_style style;
  style.height = 6;
  style.focused = true;
  for (const size_t selected : {0, 50, 99}) {
    style.selected = selected;
    const auto lines = list_lines(many(100), style);
    REQUIRE(lines.size() == 6);
    size_t marked = 0;
    for (const auto& x : lines)
      if (x.selected) {
        ++marked;
        CHECK(text_of(x) == ">n" + std::to_string(100 + selected));
      }
    CHECK(marked == 1);
  }
}

TEST_CASE("the headings tell how many there are and how they are sorted",
          "[top]") {
  list_style style;
  style.order = {"RATE", true};
  CHECK(text_of(list_lines(three(), style).front()).rfind(" NAME 3   RATE v", 0)
        == 0);
}

TEST_CASE("no line is wider than the screen, whatever its width", "[top]") {
  auto x = many(3);
  x.columns.push_back({"CPU", align::right, 1});
  x.columns.push_back({"REASON", align::left, 2});
  for (auto& row : x.rows) {
    row.emplace_back("2/4").usage = usage_share{1, 1, 4};
    row.emplace_back(std::string(200, 'x'));
  }
  for (size_t width = 0; width < 140; ++width) {
    list_style style;
    style.width = width;
    for (const auto& line : list_lines(x, style))
      CHECK(width_of(line) <= width);
  }
}

TEST_CASE("no room is no lines", "[top]") {
  list_style style;
  style.height = 0;
  CHECK(list_lines(three(), style).empty());
}
