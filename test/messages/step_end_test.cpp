#include "messages/step_end.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("An end of a step is a kind, or a kind with its plain number",
          "[step_end]") {
  const auto first = parse_step_end("input");
  REQUIRE(first);
  CHECK(first->is_input);
  CHECK(first->number == 0);
  const auto last = parse_step_end("output:12");
  REQUIRE(last);
  CHECK_FALSE(last->is_input);
  CHECK(last->number == 12);
}

TEST_CASE("What is not wholly an end of a step is none", "[step_end]") {
  for (const auto* text :
       {"", ":", ":1", "input:", "input:x", "input:1x", "input:1:2", "input:-1",
        "input:+1", "input: 1", "input:1 ", "input:01", "input:100",
        "input:99999999999999999999", "Input", "inputs:1"}) {
    INFO(text);
    CHECK_FALSE(parse_step_end(text));
  }
}

} // namespace roscell::test
