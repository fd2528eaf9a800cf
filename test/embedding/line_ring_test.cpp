#include "embedding/skills/line_ring.hpp"

#include <catch2/catch.hpp>

using roscell::embedding::line_ring;

TEST_CASE("a place in a log stays valid when older lines are dropped") {
  int reported = 0;
  line_ring log{12, [&] { ++reported; }};
  log.add("one", 1);
  log.add("two", 2);
  const auto place = log.read_from(0).next_offset;
  CHECK(place == 8);
  log.add("three", 3);
  CHECK(reported == 3);
  CHECK(log.read_from(place).text == "three\n");
  CHECK(log.read_from(0).text == "two\nthree\n");
  CHECK(log.read_from(1000).text.empty());
  CHECK(log.read_tail(1).text == "three\n");
  CHECK(log.read_tail(9).times_unix_ms == std::vector<std::int64_t>{2, 3});
}

TEST_CASE("a line of a log is one line of text, whatever is in it") {
  line_ring log{100, [] {}};
  log.add("a\nb\x1b[2J\xff", 1);
  const auto text = log.read_from(0).text;
  CHECK(text.find("a b [2J") == 0);
  CHECK(text.find('\n') == text.size() - 1);
  log.add(std::string(1000, 'x'), 2);
  CHECK(log.read_from(0).text.size() == 1001);
}
