#include "actors/edge/limits.hpp"
#include "actors/edge/process/instance_log.hpp"
#include "schemas/utf8.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

std::string lines(int from, int to) {
  std::string result;
  for (int i = from; i < to; ++i)
    result += "line " + std::to_string(i) + "\n";
  return result;
}

} // namespace

TEST_CASE("a log is read on from where the last part ended") {
  temp_folder folder;
  const instance_log log{folder.path()};
  folder.write("log.0", "one\n");
  const auto first = log.read_from(0);
  CHECK(first.text == "one\n");
  CHECK(first.next_offset == 4);
  CHECK_FALSE(first.ended);
  folder.write("log.0", "one\ntwo\n");
  CHECK(log.read_from(first.next_offset).text == "two\n");
  const auto none = log.read_from(8);
  CHECK(none.text.empty());
  CHECK(none.next_offset == 8);
}

TEST_CASE("the files of a log are one text") {
  temp_folder folder;
  folder.write("log.0", "abc");
  folder.write("log.3", "def");
  const instance_log log{folder.path()};
  CHECK(log.read_from(0).text == "abcdef");
  CHECK(log.read_from(2).text == "cdef");
  CHECK(log.read_from(3).text == "def");
  CHECK(log.read_from(4).next_offset == 6);
}

TEST_CASE("what was dropped is skipped to the oldest that is left") {
  temp_folder folder{"log.100", "abc"};
  const auto part = instance_log{folder.path()}.read_from(7);
  CHECK(part.text == "abc");
  CHECK(part.next_offset == 103);
}

TEST_CASE("an offset beyond the end is taken back to the end") {
  temp_folder folder{"log.0", "abc"};
  const auto part = instance_log{folder.path()}.read_from(1'000'000'000'000);
  CHECK(part.text.empty());
  CHECK(part.next_offset == 3);
}

TEST_CASE("parts around a gap are told apart") {
  temp_folder folder;
  folder.write("log.0", "abc");
  folder.write("log.10", "def");
  folder.write("exit", "{}");
  const instance_log log{folder.path()};
  const auto before = log.read_from(0);
  CHECK(before.text == "abc");
  CHECK_FALSE(before.ended);
  const auto behind = log.read_from(before.next_offset);
  CHECK(behind.text == "def");
  CHECK(behind.next_offset == 13);
  CHECK(behind.ended);
}

TEST_CASE("a part is bounded, and reading all parts gives all bytes") {
  temp_folder folder;
  const auto all = lines(0, 30'000);
  folder.write("log.0", all.substr(0, 100'000));
  folder.write("log.100000", all.substr(100'000));
  folder.write("exit", "{}");
  const instance_log log{folder.path()};
  std::string read;
  for (auto part = log.read_from(0);; part = log.read_from(part.next_offset)) {
    CHECK(part.text.size() <= size_t{limits::log::part_bytes});
    read += part.text;
    if (part.ended)
      break;
  }
  CHECK(read == all);
}

TEST_CASE(
    "a part with the times of its lines has so many of them that an answer "
    "can hold them") {
  temp_folder folder;
  std::string all;
  for (int i = 0; i < 20'000; ++i)
    all += "a\n";
  folder.write("log.0", all);
  folder.write("exit", "{}");
  const instance_log log{folder.path()};
  std::string read;
  for (auto part = log.read_from(0, true);;
       part = log.read_from(part.next_offset, true)) {
    CHECK(part.times_unix_ms.size() <= size_t{most_timed_lines});
    read += part.text;
    if (part.ended)
      break;
  }
  CHECK(read == all);
  CHECK(log.read_tail(20'000, true).times_unix_ms.size()
        == size_t{most_timed_lines});
  CHECK(log.read_tail(20'000, false).text == all);
}

TEST_CASE("the tail has the last lines, whatever the files") {
  temp_folder folder;
  folder.write("log.0", lines(0, 50));
  folder.write("log." + std::to_string(lines(0, 50).size()), lines(50, 60));
  const instance_log log{folder.path()};
  CHECK(log.read_tail().text == lines(40, 60));
  CHECK(log.read_tail(1).text == "line 59\n");
  CHECK(log.read_tail(1000).text == lines(0, 60));
  CHECK(log.read_tail(1).next_offset
        == static_cast<int64_t>(lines(0, 60).size()));
}

TEST_CASE("a last line without newline is a line of the tail") {
  temp_folder folder{"log.0", "one\ntwo"};
  CHECK(instance_log{folder.path()}.read_tail(1).text == "two");
}

TEST_CASE("one endless line does not make the tail long") {
  temp_folder folder{"log.0", std::string(1'000'000, 'x')};
  const auto part = instance_log{folder.path()}.read_tail(5);
  CHECK(part.text.size() == size_t{limits::log::part_bytes});
  CHECK(part.next_offset == 1'000'000);
}

TEST_CASE("a log has ended when the exit is recorded and all is read") {
  temp_folder folder{"log.0", "abc"};
  const instance_log log{folder.path()};
  CHECK_FALSE(log.read_from(3).ended);
  folder.write("exit.tmp", "");
  CHECK_FALSE(log.read_from(3).ended);
  folder.write("exit", "{}");
  CHECK(log.read_from(0).ended);
  CHECK(log.read_from(3).ended);
}

TEST_CASE("a program that printed nothing has an empty log that ends") {
  temp_folder folder;
  const instance_log log{folder.path()};
  CHECK(log.read_tail().text.empty());
  folder.write("exit", "{}");
  CHECK(log.read_tail().ended);
}

TEST_CASE("a character that is half written waits for its other half") {
  temp_folder folder{"log.0", "a\xE2\x82"};
  const instance_log log{folder.path()};
  CHECK(log.read_from(0).text == "a");
  CHECK(log.read_from(0).next_offset == 1);
  folder.write("log.0", "a\xE2\x82\xAC");
  CHECK(log.read_from(1).text == "\xE2\x82\xAC");
  folder.write("log.0", "a\xE2\x82");
  folder.write("exit", "{}");
  CHECK(log.read_from(0).text == "a\xEF\xBF\xBD");
}

TEST_CASE("binary output becomes valid text") {
  temp_folder folder{"log.0", std::string{"\x00\xFF\x80z", 4}};
  const auto part = instance_log{folder.path()}.read_from(0);
  CHECK(part.text == std::string{"\x00\xEF\xBF\xBD\xEF\xBF\xBDz", 8});
  CHECK(from_base64(part.bytes) == std::string{"\x00\xFF\x80z", 4});
  CHECK(part.next_offset == 4);
}

TEST_CASE("what is no log file of the shim is not read") {
  temp_folder folder;
  folder.write("log.x", "no");
  folder.write("log.-1", "no");
  folder.write("log.", "no");
  folder.write("log.99999999999999999999", "no");
  std::filesystem::create_symlink("/etc/passwd", folder.path() / "log.0");
  std::filesystem::create_directory(folder.path() / "log.5");
  CHECK(instance_log{folder.path()}.read_tail().text.empty());
}

TEST_CASE("the log of no instance does not exist") {
  const instance_log log{"/no/such/instance"};
  CHECK_FALSE(log.exists());
  CHECK(log.read_from(0).text.empty());
}

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
  temp_folder folder;
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
  temp_folder folder{"log.0", "one\n"};
  const instance_log log{folder.path()};
  CHECK(log.read_from(0, true).times_unix_ms == times{0});
  folder.write("times.0", "half a note");
  const auto part = log.read_from(0, true);
  CHECK(part.text == "one\n");
  CHECK(part.times_unix_ms == times{0});
}
