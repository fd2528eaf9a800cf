#include "actors/edge/process/line_times.hpp"

#include "actors/edge/process/instance_log.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;

using times = std::vector<int64_t>;

TEST_CASE("a line is as old as its first byte") {
  const std::vector<time_note> notes{{0, 10}, {2, 20}, {8, 30}};
  CHECK(line_times("one\ntwo\nsix\n", 0, notes) == times{10, 20, 30});
  CHECK(line_times("e\ntwo", 2, notes) == times{20, 20});
  CHECK(line_times("", 0, notes).empty());
}

TEST_CASE("what no note tells of has no time") {
  CHECK(line_times("a\nb\n", 0, {}) == times{0, 0});
  CHECK(line_times("a\nb\n", 0, {{2, 5}}) == times{0, 5});
  CHECK(line_times("a\n", 0, {{0, -5}}) == times{0});
}

namespace {

std::string bytes_of(const std::vector<time_note>& notes) {
  return {reinterpret_cast<const char*>(notes.data()),
          notes.size() * sizeof(time_note)};
}

} // namespace

TEST_CASE("a log tells the times of its lines, across its files") {
  own_folder folder;
  folder.write("log.0", "one\ntwo\n");
  folder.write("log.8", "six\n");
  folder.write("times.0", bytes_of({{0, 10}, {4, 20}}));
  folder.write("times.8", bytes_of({{8, 30}}));
  const instance_log log{folder.path()};
  CHECK(log.read_from(0).times_unix_ms.empty());
  CHECK(log.read_from(0, true).times_unix_ms == times{10, 20, 30});
  CHECK(log.read_from(5, true).times_unix_ms == times{20, 30});
  CHECK(log.read_tail(1, true).times_unix_ms == times{30});
}

TEST_CASE("a log without times, or with broken ones, is read nevertheless") {
  own_folder folder;
  folder.write("log.0", "one\n");
  const instance_log log{folder.path()};
  CHECK(log.read_from(0, true).times_unix_ms == times{0});
  folder.write("times.0", "half a note");
  const auto part = log.read_from(0, true);
  CHECK(part.text == "one\n");
  CHECK(part.times_unix_ms == times{0});
}
