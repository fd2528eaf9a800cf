#include "tools/roscell/view/log_lines.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;

TEST_CASE("each line of a step's log stands behind its name", "[tools]") {
  log_lines lines{"poses | "};
  CHECK(lines.add("one\ntwo\n") == "poses | one\nposes | two\n");
  CHECK(lines.add("thr") == "poses | thr");
  CHECK(lines.add("ee\n\n") == "ee\nposes | \n");
}

TEST_CASE("a log without a name is printed as it is", "[tools]") {
  log_lines lines{""};
  CHECK(lines.add("a\nb") == "a\nb");
}
