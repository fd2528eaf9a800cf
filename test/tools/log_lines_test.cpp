#include "tools/roscell/view/log_lines.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;

TEST_CASE("each line of a step's log stands behind its name", "[tools]") {
  log_lines lines{"poses | ", log_reader::program};
  CHECK(lines.add("one\ntwo\n") == "poses | one\nposes | two\n");
  CHECK(lines.add("thr") == "poses | thr");
  CHECK(lines.add("ee\n\n") == "ee\nposes | \n");
}

TEST_CASE("a log without a name is printed as it is", "[tools]") {
  log_lines lines{"", log_reader::program};
  CHECK(lines.add("a\x1b[2J\nb") == "a\x1b[2J\nb");
  CHECK(lines.finish().empty());
}

TEST_CASE("a log steers no terminal", "[tools]") {
  CHECK(harmless_line("a\x1b]52;c;eA==\x07z") == "a?]52;c;eA==?z");
  CHECK(harmless_line("\x1b[2Jx\ry") == "?[2Jx?y");
  CHECK(harmless_line("\x1b") == "?");
  CHECK(harmless_line("\xc2\x9b") == "??");
}

TEST_CASE("colours of a log are left out, its tabs and letters stay",
          "[tools]") {
  CHECK(harmless_line("\x1b[1;31mred\x1b[0m\t\tü\r") == "red\t\tü");
  CHECK(harmless_line("\x1b[m").empty());
}

TEST_CASE("a terminal gets whole lines, however they come", "[tools]") {
  log_lines lines{"poses | ", log_reader::terminal};
  CHECK(lines.add("ü \x1b[3").empty());
  CHECK(lines.add("2mgreen\ntwo\nthr\xc3") == "poses | ü green\nposes | two\n");
  CHECK(lines.add("\xbc").empty());
  CHECK(lines.finish() == "poses | thrü");
  CHECK(lines.finish().empty());
}
