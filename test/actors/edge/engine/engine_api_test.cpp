#include "actors/edge/engine/engine_api.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("an engine is spoken to in the newest version that both know") {
  CHECK(choose_api("1.41", "1.12") == "1.41");
  CHECK(choose_api("1.43", "1.12") == "1.41");
  CHECK(choose_api("1.40", "1.12") == "1.40");
  CHECK(choose_api("1.9", "1.9") == "1.9");
}

TEST_CASE("an engine that takes newer versions only is asked in its oldest") {
  CHECK(choose_api("1.52", "1.44") == "1.44");
}

TEST_CASE("an engine that says nothing of versions is asked without one") {
  for (const auto* text : {"", "1", "1.", ".1", "1.x", "one.two", "1.41 "})
    CHECK(choose_api(text, "1.12").empty());
  CHECK(choose_api("1.41", "nonsense") == "1.41");
}

} // namespace roscell::test
