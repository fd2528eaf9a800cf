#include "tools/roscell/top/layout/controls.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using namespace roscell::cli::top;

namespace {

/// Two things of each kind, and keys that somebody presses.
struct bench {
  controls now;
  tables lists;
  size_t page = 10;
  size_t lines = 0;

  bench() {
    for (auto& x : lists) {
      x.columns = {{"NAME"}, {"STATE"}};
      x.rows = {{"first", "on"}, {"second", "off"}};
    }
  }

  void press_key(const key& x) {
    press(now, x, {lists, page, lines});
  }

  void press_name(key_name x) {
    press_key({x, {}});
  }

  void type(const std::string& text) {
    for (const auto c : text)
      press_key({key_name::text, std::string(1, c)});
  }
};

} // namespace

TEST_CASE("arrows move the cursor within the list that keys mean", "[top]") {
  bench x;
  x.press_name(key_name::down);
  CHECK(x.now.lists[0].selected == "second");
  x.press_name(key_name::down);
  CHECK(x.now.lists[0].selected == "second");
  x.press_name(key_name::home);
  CHECK(x.now.lists[0].selected == "first");
  x.press_name(key_name::page_down);
  CHECK(x.now.lists[0].selected == "second");
  CHECK(x.now.lists[1].selected.empty());
}

TEST_CASE("Tab goes through the lists and back", "[top]") {
  bench x;
  x.press_name(key_name::tab);
  CHECK(x.now.list == 1);
  x.press_name(key_name::back_tab);
  x.press_name(key_name::back_tab);
  CHECK(x.now.list == 2);
  x.press_name(key_name::tab);
  CHECK(x.now.list == 0);
}

TEST_CASE("s goes through the columns, S turns the order round", "[top]") {
  bench x;
  x.type("s");
  CHECK(x.now.lists[0].order.column == "STATE");
  x.type("sS");
  CHECK(x.now.lists[0].order.column == "NAME");
  CHECK(x.now.lists[0].order.backwards);
  CHECK_FALSE(x.now.lists[1].order.backwards);
}

TEST_CASE("what is typed into the filter is no key", "[top]") {
  bench x;
  x.type("/qls");
  CHECK(x.now.filter == "qls");
  CHECK_FALSE(x.now.left);
  x.press_key({key_name::text, "ö"});
  x.press_name(key_name::backspace);
  x.press_name(key_name::backspace);
  CHECK(x.now.filter == "ql");
  x.press_name(key_name::enter);
  CHECK_FALSE(x.now.typing);
  CHECK(x.now.filter == "ql");
  x.press_name(key_name::escape);
  CHECK(x.now.filter.empty());
}

TEST_CASE("Enter shows details of what is selected, q leads back, then out",
          "[top]") {
  bench x;
  x.press_name(key_name::down);
  x.press_name(key_name::enter);
  CHECK(x.now.where == top_page::details);
  CHECK(x.now.subject.kind == thing_kind::node);
  CHECK(x.now.subject.name == "second");
  x.type("q");
  CHECK(x.now.where == top_page::overview);
  CHECK_FALSE(x.now.left);
  x.type("q");
  CHECK(x.now.left);
}

TEST_CASE("a selected thing that is gone is the first instead", "[top]") {
  bench x;
  x.now.lists[0].selected = "gone";
  x.press_name(key_name::enter);
  CHECK(x.now.subject.name == "first");
  x.lists[0].rows.clear();
  x.now = {};
  x.press_name(key_name::down);
  x.press_name(key_name::enter);
  CHECK(x.now.where == top_page::overview);
  CHECK(x.now.note == "nothing is selected");
}

TEST_CASE("only an instance has a log, and others say so", "[top]") {
  bench x;
  x.type("l");
  CHECK(x.now.where == top_page::overview);
  CHECK(x.now.note.find("only instances have a log") == 0);
  x.press_name(key_name::back_tab);
  CHECK(x.now.note.empty());
  x.type("l");
  CHECK(x.now.where == top_page::log);
}

TEST_CASE("a log follows its end until somebody looks back, and then again",
          "[top]") {
  bench x;
  x.lines = 100;
  x.press_name(key_name::back_tab);
  x.type("l");
  CHECK(x.now.at_end);
  x.press_name(key_name::up);
  CHECK_FALSE(x.now.at_end);
  CHECK(x.now.scroll == 89);
  x.lines = 120;
  x.press_name(key_name::up);
  CHECK(x.now.scroll == 88);
  x.press_name(key_name::end);
  CHECK(x.now.at_end);
}

TEST_CASE("a text has a filter of its own", "[top]") {
  bench x;
  x.now.filter = "arm";
  x.type("e/lost");
  CHECK(x.now.text_filter == "lost");
  CHECK(x.now.filter == "arm");
  x.press_name(key_name::enter);
  x.press_name(key_name::escape);
  CHECK(x.now.where == top_page::events);
  CHECK(x.now.text_filter.empty());
  x.press_name(key_name::escape);
  CHECK(x.now.where == top_page::overview);
  CHECK(x.now.filter == "arm");
}
