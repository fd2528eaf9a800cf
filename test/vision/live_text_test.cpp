#include "test/skills/files.hpp"
#include "tools/compare_poses/live_text.hpp"

#include <catch2/catch.hpp>

using namespace roscell::comparison;

TEST_CASE("a text that fits a screen is shown as it is") {
  CHECK(fitted("one\ntwo\n", {3, 3}) == "one\ntwo\n");
}

TEST_CASE("lines are cut where a terminal would wrap them") {
  CHECK(fitted("12345\n", {4, 24}) == "1234\n");
  // A degree sign is one character of two bytes.
  CHECK(fitted("12\u00b045\n", {3, 24}) == "12\u00b0\n");
}

TEST_CASE("lines that a screen has no room for are counted in the last one") {
  CHECK(fitted("1\n2\n3\n4\n5\n", {80, 5})
        == "1\n2\n3\n... and 2 more lines\n");
}

TEST_CASE("a live text is written over the former one, and nothing else") {
  live_text text;
  CHECK(text.repainted("a\nb\n", {}) == "\r\x1b[Ja\nb\n");
  CHECK(text.repainted("c\n", {}) == "\x1b[2A\r\x1b[Jc\n");
  CHECK(text.repainted("d\n", {}) == "\x1b[1A\r\x1b[Jd\n");
}

TEST_CASE("a live text never goes up further than its screen is high") {
  live_text text;
  text.repainted("1\n2\n3\n4\n5\n", {80, 10});
  CHECK(text.repainted("1\n", {80, 4}).substr(0, 4) == "\x1b[3A");
}
using roscell::comparison::file_watch;
using namespace roscell::test;

TEST_CASE("a watch tells that a file appears and grows, once each time") {
  temp_folder folder;
  file_watch watch{{folder / "lines"}};
  auto now = file_watch::clock::now();
  CHECK_FALSE(watch.wait_until(now));
  folder.write("lines", "one\n");
  CHECK(watch.wait_until(now + patience));
  CHECK_FALSE(watch.wait_until(now));
  folder.append("lines", "two\n");
  CHECK(watch.wait_until(now + patience));
}

TEST_CASE("a folder that is not there cannot be watched") {
  CHECK_THROWS_AS(file_watch({"/nowhere/lines"}), std::runtime_error);
}
