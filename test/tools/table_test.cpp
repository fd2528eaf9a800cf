#include "tools/roscell/view/table.hpp"

#include "test/printed_text.hpp"
#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using roscell::test::cells_in;
using roscell::test::widest_line;

namespace {

table sample_table() {
  return {{{"NODE"}, {"CPU", align::right}, {"STATE"}},
          {{"größe", "2", "active"}, {"b", "0.25", "lost"}}};
}

table ranked() {
  return {{{"NODE"},
           {"ADDRESS", align::left, 2, true},
           {"CPU", align::right, 1},
           {"REASON", align::left, 3}},
          {{"arm-1", "10.0.0.1:8420", "2", "it has been silent for 8 s"},
           {"b", "10.0.0.2:8420", "0.25", ""}}};
}

text_style of_width(size_t width) {
  text_style result;
  result.width = width;
  return result;
}

} // namespace

TEST_CASE("columns are aligned under their headings by letters, not bytes",
          "[tools]") {
  CHECK(sample_table().render({})
        == "NODE    CPU  STATE\n"
           "größe     2  active\n"
           "b      0.25  lost\n");
}

TEST_CASE("a missing or empty cell is a dash", "[tools]") {
  const table t{{{"A"}, {"B"}, {"C"}}, {{"x", ""}}};
  CHECK(cells_in(t.render({})) == "A|B|C\nx|-|-\n");
}

TEST_CASE("a foreign cell cannot break the line", "[tools]") {
  const table t{{{"A"}, {"B"}}, {{"x\ny\x1b[2J", "z"}}};
  CHECK(cells_in(t.render({})) == "A|B\nx?y?[2J|z\n");
}

TEST_CASE("no line is wider than the terminal", "[tools]") {
  const auto text = sample_table().render(of_width(12));
  CHECK(cells_in(text) == "NODE|CPU…\ngröße|2…\nb|0.25…\n");
  CHECK(widest_line(text) == 12);
}

TEST_CASE("a table gives up width where it matters least", "[tools]") {
  const auto text = ranked().render(of_width(46));
  CHECK(cells_in(text)
        == "NODE|ADDRESS|CPU|REASON\n"
           "arm-1|10.0.0.1:8420|2|it has been silen…\n"
           "b|10.0.0.2:8420|0.25|-\n");
  CHECK(widest_line(text) == 46);
}

TEST_CASE("a table says which columns it has left out", "[tools]") {
  CHECK(cells_in(ranked().render(of_width(34)))
        == "NODE|ADDRESS|CPU\n"
           "arm-1|10.0.0.1:8420|2\n"
           "b|10.0.0.2:8420|0.25\n"
           "1 column left out: REASON; -o wid…\n");
  CHECK(cells_in(ranked().render(of_width(12)))
        == "NODE|CPU\narm-1|2\nb|0.25\n2 columns l…\n");
}

TEST_CASE("a column in which nothing stands is the first that goes",
          "[tools]") {
  const table t{{{"A"}, {"EMPTY", align::left, 1}, {"B", align::left, 2}},
                {{"some text", "", "more text"}}};
  CHECK(cells_in(t.render(of_width(20))).find("some text|more text\n")
        != std::string::npos);
}

TEST_CASE("a wide table is neither cut nor without a column", "[tools]") {
  table t{{{"A"}, {"B", align::left, only_wide}}, {{"a", "a long text"}}};
  CHECK(t.render({}) == "A\na\n");
  auto wide = of_width(5);
  wide.tables.wide = true;
  CHECK(cells_in(t.render(wide)) == "A|B\na|a long text\n");
}

TEST_CASE("a table can do without headings", "[tools]") {
  text_style bare;
  bare.tables.headings = false;
  const auto whole = sample_table().render({});
  CHECK(sample_table().render(bare) == whole.substr(whole.find('\n') + 1));
  const table t{{{"A LONG HEADING"}, {"B"}}, {{"a", "b"}}};
  CHECK(t.render(bare) == "a  b\n");
}

TEST_CASE("columns are chosen by their names", "[tools]") {
  text_style chosen;
  chosen.tables.columns = {"state", "NODE"};
  CHECK(cells_in(sample_table().render(chosen))
        == "STATE|NODE\nactive|größe\nlost|b\n");
  chosen.tables.columns = {"discovery-server"};
  const table spaced{{{"DISCOVERY SERVER"}}, {{"x"}}};
  CHECK(spaced.render(chosen) == "DISCOVERY SERVER\nx\n");
}

TEST_CASE("a column that there is not is refused with those that there are",
          "[tools]") {
  text_style wrong;
  wrong.tables.columns = {"PORT"};
  const auto refusal = [&] {
    try {
      sample_table().render(wrong);
    } catch (const command_error& e) {
      return e.what() + (": " + e.hint);
    }
    return std::string{};
  };
  const std::string hint =
      "there is no column 'PORT': the columns are NODE, CPU, STATE";
  CHECK(refusal() == hint);
  wrong.tables = {};
  wrong.tables.sort = "-PORT";
  CHECK(refusal() == hint);
}

TEST_CASE("rows are sorted by the value of a column, or from its end",
          "[tools]") {
  const table t{{{"N"}, {"X", align::right}},
                {{"a", "10"}, {"b", ""}, {"c", "9"}, {"d", "word"}}};
  text_style sorted;
  sorted.tables.headings = false;
  sorted.tables.sort = "X";
  CHECK(cells_in(t.render(sorted)) == "c|9\na|10\nd|word\nb|-\n");
  sorted.tables.sort = "-x";
  CHECK(cells_in(t.render(sorted)) == "d|word\na|10\nc|9\nb|-\n");
}

TEST_CASE("a cell's value is its number with its unit", "[tools]") {
  CHECK(cell_value("12") == 12);
  CHECK(cell_value("-1.5") == -1.5);
  CHECK(cell_value("0.5/4") == 0.5);
  CHECK(cell_value("29.9 Hz") == 29.9);
  CHECK(*cell_value("1 GiB") == 1024 * *cell_value("1 MiB"));
  CHECK(*cell_value("0.5/3.8 GiB") == 512 * *cell_value("1 MiB"));
  CHECK(cell_value("42s") == 42);
  CHECK(cell_value("3m05s") == 185);
  CHECK(*cell_value("5d03h") > *cell_value("23h59m"));
  for (const auto* text : {"", "arm-1", "t-a-1a2b", "10.0.0.1:8420", "-", "1x"})
    CHECK_FALSE(cell_value(text));
}

TEST_CASE("colours change no column", "[tools]") {
  text_style coloured;
  coloured.colour = true;
  auto text = sample_table().render(coloured);
  CHECK(text.find("\x1b[32mactive\x1b[0m") != text.npos);
  CHECK(text.find("\x1b[31mlost\x1b[0m") != text.npos);
  for (auto begin = text.find('\x1b'); begin != text.npos;
       begin = text.find('\x1b'))
    text.erase(begin, text.find('m', begin) - begin + 1);
  CHECK(text == sample_table().render({}));
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

TEST_CASE("a column that is there only if something stands in it", "[tools]") {
  table t{{{"A"}, {"WHY", align::left, 1, false, true}}, {{"a", ""}}};
  CHECK(t.render({}) == "A\na\n");
  t.rows.push_back({"b", "lost"});
  CHECK(cells_in(t.render({})) == "A|WHY\na|-\nb|lost\n");
}

TEST_CASE("a filter is looked for in all cells of a row, in any case",
          "[tools]") {
  text_style filtered;
  filtered.tables.headings = false;
  filtered.tables.filter = "LOS";
  CHECK(cells_in(sample_table().render(filtered)) == "b|0.25|lost\n");
  filtered.tables.filter = "nothing";
  CHECK(sample_table().render(filtered).empty());
}

namespace {

std::string bar_text(const usage_share& of, size_t width, bool utf8) {
  line x;
  x.spans = bar(of, width, utf8);
  return text_of(x);
}

} // namespace

TEST_CASE("a bar tells others, instances and what is free by characters",
          "[tools]") {
  CHECK(bar_text({2, 1, 4}, 8, false) == "####++..");
  CHECK(bar_text({2, 1, 4}, 8, true) == "████▒▒··");
  CHECK(bar_text({0, 0, 4}, 4, false) == "....");
}

TEST_CASE("a bar shows the least amount, and never more than its width",
          "[tools]") {
  CHECK(bar_text({0.001, 0.001, 100}, 5, false) == "#+...");
  CHECK(bar_text({9, 9, 10}, 5, false) == "+++++");
  CHECK(bar_text({9, 1, 5}, 5, false) == "####+");
  CHECK(bar_text({1, 1, 0}, 3, false) == "...");
  CHECK(bar_text({1, 1, 4}, 0, false).empty());
}

TEST_CASE("an amount has its bar before it where bars are wanted", "[tools]") {
  cell used{"3/4"};
  used.usage = usage_share{2, 1, 4};
  const table t{{{"NODE"}, {"CPU", align::right}}, {{"arm", used}}};
  CHECK(cells_in(t.render({})) == "NODE|CPU\narm|3/4\n");
  text_style drawn;
  drawn.bars = true;
  drawn.utf8 = false;
  CHECK(t.render(drawn) == "NODE             CPU\narm   #####+++.. 3/4\n");
}

TEST_CASE("a wide character takes two columns of a table", "[tools]") {
  const table t{{{"A"}, {"B"}}, {{"机器人", "x"}, {"robot", "y"}}};
  CHECK(t.render({}) == "A       B\n机器人  x\nrobot   y\n");
}
