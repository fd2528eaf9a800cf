#include "actors/edge/history/event_lines.hpp"
#include "actors/edge/history/limits.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("after a loss of power numbers begin above all that were given") {
  temp_folder folder;
  const auto file = folder.path() / "numbers";
  uint64_t given = 0;
  {
    event_numbers numbers{file};
    CHECK(numbers.before() == 0);
    for (; given < 3 * limits::history::numbers; given += 100) {
      REQUIRE_FALSE(numbers.set_aside(given));
      // Before the next time so many may be given.
      CHECK(numbers.end() >= given + 100);
    }
  }
  CHECK(event_numbers{file}.before() >= given);
}

TEST_CASE("after an orderly end numbers go on without a gap") {
  temp_folder folder;
  const auto file = folder.path() / "numbers";
  event_numbers numbers{file};
  REQUIRE_FALSE(numbers.set_aside(0));
  REQUIRE_FALSE(numbers.finish(17));
  CHECK(event_numbers{file}.before() == 17);
}

TEST_CASE("a file of numbers that is damaged says nothing") {
  temp_folder folder;
  const auto file = folder.path() / "numbers";
  const auto* text = GENERATE("", "x", "-5\n", "99999999999999999999999\n",
                              "9999999999999999\n");
  std::ofstream{file} << text;
  CHECK(event_numbers{file}.before() == 0);
}

TEST_CASE("numbers are set aside in place, which takes no more room") {
  temp_folder folder;
  const auto file = folder.path() / "numbers";
  event_numbers numbers{file};
  REQUIRE_FALSE(numbers.set_aside(1));
  const auto size = std::filesystem::file_size(file);
  REQUIRE_FALSE(numbers.set_aside(uint64_t{1} << 40));
  CHECK(std::filesystem::file_size(file) == size);
}
