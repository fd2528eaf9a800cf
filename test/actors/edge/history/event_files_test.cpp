#include "actors/edge/history/event_files.hpp"
#include "actors/edge/history/event_lines.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/limit_units.hpp"
#include "actors/node/limits.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr int64_t now_ms = 1'800'000'000'000;

event numbered(uint64_t number, int64_t time = now_ms) {
  return {number, time, "node_joined", "arm", R"({"n":1})"};
}

std::vector<event> from_to(uint64_t first, uint64_t last) {
  std::vector<event> result;
  for (auto i = first; i <= last; ++i)
    result.push_back(numbered(i, now_ms + static_cast<int64_t>(i)));
  return result;
}

std::vector<uint64_t> numbers_of(const std::vector<event>& events) {
  std::vector<uint64_t> result;
  for (const auto& x : events)
    result.push_back(x.sequence);
  return result;
}

/// All parts, one after the other.
std::vector<uint64_t> all_of(const event_files& files,
                             past_events_query query = {}) {
  std::vector<uint64_t> result;
  for (;;) {
    const auto part = numbers_of(files.read(query));
    if (part.empty())
      return result;
    result.insert(result.end(), part.begin(), part.end());
    query = {result.back(), 0, 0};
  }
}

/// A file of its own for each batch.
void fill_files(event_files& files, uint64_t count) {
  int64_t time = now_ms;
  for (uint64_t i = 1; i <= count; ++i) {
    REQUIRE_FALSE(files.append({numbered(i, time)}, time));
    time += std::chrono::milliseconds{limits::history::file_age}.count();
  }
}

} // namespace

TEST_CASE("what has been written is read by the next run, in its order") {
  temp_folder folder;
  {
    event_files files{folder.path()};
    REQUIRE_FALSE(files.append(from_to(7, 9), now_ms));
    REQUIRE_FALSE(files.append(from_to(10, 12), now_ms));
  }
  event_files files{folder.path()};
  CHECK(files.highest() == 12);
  CHECK(all_of(files) == std::vector<uint64_t>{7, 8, 9, 10, 11, 12});
  const auto part = files.read({11, 0, 0});
  REQUIRE(part.size() == 1);
  CHECK(part[0] == numbered(12, now_ms + 12));
}

TEST_CASE("a long past comes in parts") {
  temp_folder folder;
  event_files files{folder.path()};
  const auto count = 3 * limits::history::part + 1;
  REQUIRE_FALSE(files.append(from_to(1, count), now_ms));
  CHECK(files.read({}).size() == limits::history::part);
  CHECK(all_of(files).size() == count);
}

TEST_CASE("the past begins at a number, at a time, or so many before its end") {
  temp_folder folder;
  event_files files{folder.path()};
  REQUIRE_FALSE(files.append(from_to(1, 20), now_ms + 20));
  CHECK(all_of(files, {18, 0, 0}) == std::vector<uint64_t>{19, 20});
  CHECK(all_of(files, {0, now_ms + 19, 0}) == std::vector<uint64_t>{19, 20});
  CHECK(all_of(files, {0, 0, 2}) == std::vector<uint64_t>{19, 20});
  CHECK(all_of(files, {19, 0, 5}) == std::vector<uint64_t>{20});
  CHECK(all_of(files, {0, now_ms + 21, 0}).empty());
  CHECK(all_of(files, {20, 0, 0}).empty());
}

TEST_CASE("a clock that is set back hides nothing that came later") {
  temp_folder folder;
  event_files files{folder.path()};
  REQUIRE_FALSE(files.append({numbered(1, now_ms), numbered(2, now_ms + 10),
                              numbered(3, 1000), numbered(4, now_ms)},
                             now_ms + 10));
  CHECK(all_of(files, {0, now_ms + 5, 0}) == std::vector<uint64_t>{2, 3, 4});
}

TEST_CASE("a host that begins in 1970 hides nothing of the days before") {
  temp_folder folder;
  event_files files{folder.path()};
  REQUIRE_FALSE(files.append(from_to(1, 3), now_ms + 3));
  REQUIRE_FALSE(files.append({numbered(4, 1000)}, 1000));
  REQUIRE_FALSE(files.append({numbered(5, now_ms + 50)}, now_ms + 50));
  CHECK(all_of(files, {0, now_ms + 2, 0}) == std::vector<uint64_t>{2, 3, 4, 5});
}

TEST_CASE("a line that a loss of power has torn costs itself alone") {
  temp_folder folder;
  {
    event_files files{folder.path()};
    REQUIRE_FALSE(files.append(from_to(1, 3), now_ms));
  }
  const auto file = folder.path() / "events.1";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 9);
  event_files files{folder.path()};
  REQUIRE_FALSE(files.append(from_to(5, 6), now_ms));
  CHECK(all_of(files) == std::vector<uint64_t>{1, 2, 5, 6});
}

TEST_CASE("what is no event of ours is passed over, whatever it is") {
  temp_folder folder;
  {
    event_files files{folder.path()};
    REQUIRE_FALSE(files.append(from_to(1, 1), now_ms));
  }
  std::ofstream{folder.path() / "events.1", std::ios::app}
      << "2 {}\n3 [[[[\n4\n\n5 {\"type\":\"event\"}\n6 " << line_of(numbered(7))
      << std::string(100'000, 'x') << "\n"
      << line_of(numbered(8));
  std::ofstream{folder.path() / "events.x"} << line_of(numbered(50));
  std::ofstream{folder.path() / "notes"} << "mine";
  std::filesystem::create_directory(folder.path() / "events.60");
  std::filesystem::create_symlink("/etc/passwd", folder.path() / "events.70");
  event_files files{folder.path()};
  CHECK(all_of(files) == std::vector<uint64_t>{1, 8});
  while (files.drop_oldest()) {
  }
  CHECK(std::filesystem::exists(folder.path() / "notes"));
  CHECK(std::filesystem::is_symlink(folder.path() / "events.70"));
}

TEST_CASE("a file that is large or old gets no more") {
  temp_folder folder;
  event_files files{folder.path()};
  SECTION("old") {
    fill_files(files, 5);
    CHECK(all_of(files) == std::vector<uint64_t>{1, 2, 3, 4, 5});
    CHECK(files.oldest_unix_ms() == now_ms);
    CHECK(files.drop_oldest());
    CHECK(all_of(files) == std::vector<uint64_t>{2, 3, 4, 5});
  }
  SECTION("large") {
    auto big = numbered(1);
    big.data = R"({"text":")" + std::string(60'000, 'x') + R"("})";
    for (uint64_t i = 1; i <= 40; ++i) {
      big.sequence = i;
      REQUIRE_FALSE(files.append({big}, now_ms));
    }
    CHECK(all_of(files).size() == 40);
    const auto before = files.bytes();
    CHECK(files.drop_oldest());
    CHECK(files.bytes() < before);
    CHECK(files.bytes() > 0);
    // Only whole files go.
    CHECK(all_of(files).front() > 10);
  }
}

TEST_CASE("what cannot be written whole is taken back") {
  temp_folder folder;
  event_files files{folder.path() / "not there"};
  const auto why = files.append(from_to(1, 2), now_ms);
  REQUIRE(why);
  CHECK(why->message.find("events.1") != std::string::npos);
  CHECK_FALSE(why->hint.empty());
  CHECK(files.bytes() == 0);
}

TEST_CASE("what is too long for a line is kept without its particulars") {
  temp_folder folder;
  event_files files{folder.path()};
  auto long_event = numbered(1);
  long_event.data = R"({"x":")" + std::string(limits::mib, 'x') + R"("})";
  auto long_subject = numbered(2);
  long_subject.subject = std::string(255, 's') + "\xC3\xA4 and more";
  REQUIRE_FALSE(files.append({long_event, long_subject, numbered(3)}, now_ms));
  const auto found = files.read({});
  REQUIRE(numbers_of(found) == std::vector<uint64_t>{1, 2, 3});
  CHECK(found[0].data
        == R"({"left_out_bytes":)" + std::to_string(long_event.data.size())
               + "}");
  CHECK(found[1].subject == std::string(255, 's'));
  CHECK(found[1].data == long_subject.data);
}

TEST_CASE("a batch of long events is read back whole") {
  temp_folder folder;
  event_files files{folder.path()};
  std::vector<event> batch;
  for (uint64_t i = 1; i <= limits::history::batch; ++i) {
    batch.push_back(numbered(i));
    batch.back().data = R"({"x":")" + std::string(60'000, 'x') + R"("})";
  }
  REQUIRE_FALSE(files.append(batch, now_ms));
  CHECK(event_files{folder.path()}.highest() == limits::history::batch);
  CHECK(all_of(files).size() == limits::history::batch);
}

TEST_CASE("the past begins at a time in whichever file that is") {
  temp_folder folder;
  event_files files{folder.path()};
  fill_files(files, 5);
  const auto age = std::chrono::milliseconds{limits::history::file_age}.count();
  CHECK(all_of(files, {0, now_ms + 3 * age, 0}) == std::vector<uint64_t>{4, 5});
  CHECK(all_of(files, {4, now_ms + 3 * age, 0}) == std::vector<uint64_t>{5});
  CHECK(all_of(files, {0, now_ms + 5 * age, 0}).empty());
}
