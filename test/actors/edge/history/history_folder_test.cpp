#include "actors/edge/history/history_folder.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/limit_units.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>

#include <fstream>
#include <string>
#include <variant>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

constexpr history_bound plenty{64 * limits::mib, 24h * 7};

event_batch big_batch(uint64_t first, size_t count, size_t bytes) {
  event_batch result;
  for (size_t i = 0; i < count; ++i)
    result.events.push_back({first + i, 1'700'000'000'000, "node_joined", "arm",
                             R"({"x":")" + std::string(bytes, 'x') + R"("})"});
  return result;
}

bool write_to(history_folder& history, const event_batch& batch) {
  return std::holds_alternative<events_written>(history.write(batch));
}

/// As if it had been written so long ago.
void make_old(const std::filesystem::path& file, std::chrono::hours age) {
  std::filesystem::last_write_time(
      file, std::filesystem::file_time_type::clock::now() - age);
}

} // namespace

TEST_CASE("a history is for its user alone") {
  temp_folder folder;
  const history_folder history{folder.path() / "history", plenty};
  struct stat info {};
  REQUIRE(::stat((folder.path() / "history").c_str(), &info) == 0);
  CHECK((info.st_mode & 077) == 0);
}

TEST_CASE("events of a run begin above those of all earlier ones") {
  temp_folder folder;
  const auto path = folder.path() / "history";
  {
    history_folder history{path, plenty};
    CHECK(history.first_number() == 0);
    REQUIRE(write_to(history, big_batch(1, 10, 10)));
  }
  uint64_t after_power_cut = 0;
  {
    history_folder history{path, plenty};
    after_power_cut = history.first_number();
    CHECK(after_power_cut >= 10);
    auto last = big_batch(after_power_cut + 1, 1, 10);
    last.last = true;
    REQUIRE(write_to(history, last));
  }
  CHECK(history_folder{path, plenty}.first_number() == after_power_cut + 1);
}

TEST_CASE("without its file of numbers events still get new ones") {
  temp_folder folder;
  const auto path = folder.path() / "history";
  {
    history_folder history{path, plenty};
    REQUIRE(write_to(history, big_batch(1, 10, 10)));
  }
  std::filesystem::remove(path / "numbers");
  CHECK(history_folder{path, plenty}.first_number() == 10);
}

TEST_CASE("the bound in bytes is held, and the oldest goes first") {
  temp_folder folder;
  const auto path = folder.path() / "history";
  const history_bound bound{limits::history::least_bytes, 24h};
  history_folder history{path, bound};
  for (uint64_t i = 0; i < 60; ++i)
    REQUIRE(write_to(history, big_batch(1 + 10 * i, 10, 10'000)));
  uint64_t bytes = 0;
  for (const auto& x : std::filesystem::directory_iterator{path})
    bytes += x.is_regular_file() ? x.file_size() : 0;
  CHECK(bytes <= bound.bytes);
  CHECK(bytes > bound.bytes / 4);
  CHECK(history.read({0, 0, 1}).at(0).sequence == 600);
  CHECK(history.read({}).at(0).sequence > 100);
}

TEST_CASE("what is too old goes") {
  temp_folder folder;
  const auto path = folder.path() / "history";
  {
    history_folder history{path, plenty};
    REQUIRE(write_to(history, big_batch(1, 1, 10)));
  }
  make_old(path / "events.1", 24h * 6);
  CHECK(history_folder{path, plenty}.read({}).size() == 1);
  make_old(path / "events.1", 24h * 8);
  CHECK(history_folder{path, plenty}.read({}).empty());
}

TEST_CASE("a history gives way to what matters more, half of it at a time") {
  temp_folder folder;
  history_folder history{folder.path() / "history", plenty};
  for (uint64_t i = 0; i < 60; ++i)
    REQUIRE(write_to(history, big_batch(1 + 10 * i, 10, 10'000)));
  REQUIRE(history.make_room());
  CHECK(history.read({0, 0, 1}).size() == 1);
  int times = 0;
  while (history.make_room())
    REQUIRE(++times < 20);
  CHECK(history.read({}).empty());
}

TEST_CASE("a history whose folder cannot be made refuses, and harms nobody") {
  temp_folder folder;
  const auto path = folder.path() / "history";
  std::ofstream{path} << "a file";
  history_folder history{path, plenty};
  auto done = history.write(big_batch(1, 1, 10));
  REQUIRE(std::holds_alternative<edge_error>(done));
  CHECK(std::get<edge_error>(done).message.find("history")
        != std::string::npos);
  CHECK(history.read({}).empty());
  CHECK_FALSE(history.make_room());
}
