#include "actors/instances/exec/exec_table.hpp"

#include "actors/edge/exec/limits.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <string>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

constexpr exec_table::time_point start{};

} // namespace

TEST_CASE("output comes in parts of one stream, in the order it was written") {
  exec_backlog x;
  x.add(false, "one ");
  x.add(false, "two");
  x.add(true, "oops");
  auto part = x.front();
  CHECK(part.bytes == "one two");
  CHECK_FALSE(part.of_errors);
  CHECK_FALSE(part.is_last);
  CHECK(part.next_offset == 7);
  REQUIRE(x.acknowledge(7));
  part = x.front();
  CHECK(part.bytes == "oops");
  CHECK(part.of_errors);
  CHECK(part.is_last);
  REQUIRE(x.acknowledge(11));
  CHECK(x.empty());
  CHECK(x.front().next_offset == 11);
}

TEST_CASE("output that nobody has acknowledged is given again") {
  exec_backlog x;
  x.add(false, "abcdef");
  CHECK(x.front().bytes == "abcdef");
  CHECK(x.front().bytes == "abcdef");
  REQUIRE(x.acknowledge(2));
  CHECK(x.front().bytes == "cdef");
  CHECK_FALSE(x.acknowledge(1));
  CHECK_FALSE(x.acknowledge(7));
}

TEST_CASE("no part of output is longer than an answer takes") {
  exec_backlog x;
  const std::string large(limits::exec::part_bytes + 1, 'x');
  x.add(false, large);
  CHECK(x.front().bytes.size() == limits::exec::part_bytes);
  CHECK_FALSE(x.front().is_last);
  CHECK(x.has_room());
  x.add(true, std::string(limits::exec::waiting_bytes, 'y'));
  CHECK_FALSE(x.has_room());
}

TEST_CASE("a node runs so many commands at a time and no more") {
  exec_table x;
  for (size_t i = 0; i < limits::exec::most; ++i)
    REQUIRE(x.begin(std::to_string(i), "i", false, start));
  CHECK_FALSE(x.begin("one more", "i", false, start));
  x.remove("0");
  CHECK(x.begin("one more", "i", false, start));
}

TEST_CASE("a command lapses when nobody asks for anything of it") {
  exec_table x;
  CHECK_FALSE(x.next_lapse());
  x.begin("a", "i", false, start);
  x.begin("b", "i", false, start + 1s);
  CHECK(x.next_lapse() == start + limits::exec::lease);
  CHECK(x.lapsed(start + limits::exec::lease - 1ms).empty());
  x.hear_of("a", start + 2s);
  CHECK(x.next_lapse() == start + 1s + limits::exec::lease);
  CHECK(x.lapsed(start + 1s + limits::exec::lease)
        == std::vector<std::string>{"b"});
}

TEST_CASE("input is given once, in its order") {
  exec_session x;
  x.input_offset = 10;
  CHECK(judge_input(x, 10, 5) == exec_verdict::take);
  CHECK(judge_input(x, 5, 5) == exec_verdict::known);
  CHECK(judge_input(x, 5, 6) == exec_verdict::misplaced);
  CHECK(judge_input(x, 11, 1) == exec_verdict::misplaced);
  x.input_pending = true;
  CHECK(judge_input(x, 10, 5) == exec_verdict::wait);
  CHECK(judge_input(x, 10, 0) == exec_verdict::note_end);
  x.input_ended = true;
  CHECK(judge_input(x, 10, 0) == exec_verdict::known);
  CHECK(judge_input(x, 10, 1) == exec_verdict::misplaced);
}

TEST_CASE("of a command no more is told than its program") {
  CHECK(first_word({"/usr/bin/psql", "--password=secret"}) == "psql");
  CHECK(first_word({"env"}) == "env");
  CHECK(first_word({}).empty());
  CHECK(first_word({std::string(1000, 'a')}).size() == 64);
}
