#include "actors/edge/dds/lives/number_reserve.hpp"

#include "test/actors/edge/io/edge_fixture.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace roscell;
using namespace roscell::test::wire;

TEST_CASE("no number of an earlier life is used again, however it ended") {
  const scratch_folder folder;
  const auto file = std::string{folder.path("numbers")};
  const auto used = GENERATE(
      std::int64_t{0}, number_reserve::sequence_block / 2,
      number_reserve::sequence_block, 3 * number_reserve::sequence_block);
  std::int64_t last = 0;
  std::uint32_t count = 0;
  for (int life = 0; life < 3; ++life) {
    number_reserve numbers{file};
    const auto begin = numbers.begin_life();
    CHECK(begin >= last);
    CHECK(numbers.next_count() > count);
    for (std::int64_t i = 1; i <= used; ++i)
      numbers.use_sequence(begin + i);
    last = begin + used;
    for (int i = 0; i < 100; ++i)
      count = numbers.next_count();
  }
}

TEST_CASE("servers of one process share no numbers either") {
  number_reserve numbers;
  const auto first = numbers.begin_life();
  CHECK(first == 0);
  numbers.use_sequence(first + 2000);
  CHECK(numbers.begin_life() > first + 2000);
}

TEST_CASE("counts outlast the block that was set aside") {
  const scratch_folder folder;
  const auto file = std::string{folder.path("numbers")};
  std::uint32_t last = 0;
  {
    number_reserve numbers{file};
    numbers.begin_life();
    for (std::int64_t i = 0; i < 2 * number_reserve::count_block; ++i)
      last = numbers.next_count();
  }
  number_reserve later{file};
  later.begin_life();
  CHECK(later.next_count() > last);
}

TEST_CASE("where nothing is known of earlier lives numbers begin far above 1") {
  const scratch_folder folder;
  const auto file = std::string{folder.path("numbers")};
  const std::string text = GENERATE("", "-1 7", "x", "1 99999999999999999999");
  std::ofstream{file} << text;
  number_reserve numbers{file};
  CHECK(numbers.begin_life() > 100'000);
  CHECK(numbers.next_count() > 1'000'000);
}

TEST_CASE("numbers of a new node begin where those who hear it soon are") {
  const scratch_folder folder;
  const auto file = std::string{folder.path("numbers")};
  number_reserve numbers{file, {}, number_reserve::former_lives::few};
  const auto begin = numbers.begin_life();
  CHECK(begin > 1000);
  CHECK(begin < 10'000);
  CHECK(numbers.next_count() > 1'000'000);
}

TEST_CASE("who cannot write the file says so and goes on") {
  std::string said;
  number_reserve numbers{"/nonexistent/numbers",
                         [&said](const std::string& why) { said = why; }};
  numbers.begin_life();
  CHECK(said.find("/nonexistent/numbers") != std::string::npos);
  CHECK(numbers.next_count() > 0);
}
