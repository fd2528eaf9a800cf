#include "tools/roscell/view/table.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;

namespace {

table sample() {
  return {{{"NODE"}, {"CPU", align::right}, {"STATE"}},
          {{"arm-1", "2", "active"}, {"b", "0.25", "lost"}}};
}

} // namespace

TEST_CASE("columns are aligned under their headings", "[tools]") {
  CHECK(sample().render({})
        == "NODE    CPU  STATE\n"
           "arm-1     2  active\n"
           "b      0.25  lost\n");
}

TEST_CASE("a missing or empty cell is a dash", "[tools]") {
  const table t{{{"A"}, {"B"}, {"C"}}, {{"x", ""}}};
  CHECK(t.render({}) == "A  B  C\nx  -  -\n");
}

TEST_CASE("a foreign cell cannot break the line", "[tools]") {
  const table t{{{"A"}, {"B"}}, {{"x\ny\x1b[2J", "z"}}};
  CHECK(t.render({}) == "A        B\nx?y?[2J  z\n");
}

TEST_CASE("letters count as columns, not their bytes", "[tools]") {
  const table t{{{"A"}, {"B"}}, {{"größe", "1"}, {"klein", "2"}}};
  CHECK(t.render({}) == "A      B\ngröße  1\nklein  2\n");
}

TEST_CASE("no line is wider than the terminal", "[tools]") {
  text_style narrow;
  narrow.width = 12;
  CHECK(sample().render(narrow)
        == "NODE    CPU…\n"
           "arm-1     2…\n"
           "b      0.25…\n");
}

TEST_CASE("colours change no column", "[tools]") {
  text_style coloured;
  coloured.colour = true;
  auto text = sample().render(coloured);
  CHECK(text.find("\x1b[32mactive\x1b[0m") != text.npos);
  CHECK(text.find("\x1b[31mlost\x1b[0m") != text.npos);
  for (auto begin = text.find('\x1b'); begin != text.npos;
       begin = text.find('\x1b'))
    text.erase(begin, text.find('m', begin) - begin + 1);
  CHECK(text == sample().render({}));
}

TEST_CASE("only state words get a colour", "[tools]") {
  CHECK(state_colour("running") == "\x1b[32m");
  CHECK(state_colour("failed") == "\x1b[31m");
  CHECK(state_colour("starting") == "\x1b[33m");
  CHECK(state_colour("already_member") == "\x1b[32m");
  CHECK(state_colour("returned") == "\x1b[31m");
  CHECK(state_colour("unresolved") == "\x1b[33m");
  CHECK(state_colour("arm-1").empty());
}
