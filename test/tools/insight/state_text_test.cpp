#include "tools/roscell/insight/insight_views.hpp"

#include <catch2/catch.hpp>

namespace roscell::cli {

TEST_CASE("a state has a line per member, and what is within is indented",
          "[tools]") {
  const auto state = json::parse(
      R"({"phase":"active","frames":{"open":2,"list":[1,2]},"lost":[]})");
  CHECK(state_text(state)
        == "frames:\n  list: 1, 2\n  open: 2\nlost: none\nphase: active\n");
}

TEST_CASE("a list that is long or of objects has a line per element",
          "[tools]") {
  CHECK(state_text(json::parse(R"([{"a":1},{"a":2}])"))
        == "-\n  a: 1\n-\n  a: 2\n");
  const json words(20, "twenty times");
  const auto text = state_text(json{{"words", words}});
  CHECK(text.find("words:\n  - twenty times\n") == 0);
}

TEST_CASE("a state of one value is one line, and harmless", "[tools]") {
  CHECK(state_text(json("")) == "-\n");
  CHECK(state_text(json::object()) == "none\n");
  CHECK(state_text(json{{"name", "a\x1b[2J"}}) == "name: a?[2J\n");
}

} // namespace roscell::cli
