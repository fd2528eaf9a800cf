#include "actors/edge/dds/lives/number_reserve.hpp"
#include "actors/edge/dds/rtps/discovery_wire.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <fstream>
#include <memory>
#include <vector>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("no number of an earlier life is used again, however it ended") {
  const temp_folder folder;
  const auto file = folder / "numbers";
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
  const temp_folder folder;
  const auto file = folder / "numbers";
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
  const temp_folder folder;
  const auto file = folder / "numbers";
  const std::string text = GENERATE("", "-1 7", "x", "1 99999999999999999999");
  std::ofstream{file} << text;
  number_reserve numbers{file};
  CHECK(numbers.begin_life() > 100'000);
  CHECK(numbers.next_count() > 1'000'000);
}

TEST_CASE("numbers of a new node begin where those who hear it soon are") {
  const temp_folder folder;
  const auto file = folder / "numbers";
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

namespace {

using bytes = std::vector<std::uint8_t>;

/// One message of one submessage, in either byte order.
class message {
public:
  message(submessage_kind kind, bool little_endian, std::uint8_t flags = 0)
      : little_endian_(little_endian), bytes_{'R', 'T', 'P', 'S', 2, 3, 1,
                                              15,  0,   0,   0,   0, 0, 0,
                                              0,   0,   0,   0,   0, 0} {
    bytes_.push_back(static_cast<std::uint8_t>(kind));
    bytes_.push_back(
        static_cast<std::uint8_t>(flags | (little_endian ? 1 : 0)));
    u16(0);
  }

  message& u16(std::uint16_t x) {
    return number(x, 2);
  }
  message& u32(std::uint32_t x) {
    return number(x, 4);
  }
  message& sequence(std::int64_t x) {
    u32(static_cast<std::uint32_t>(x >> 32));
    return u32(static_cast<std::uint32_t>(x));
  }
  message& raw(const bytes& x) {
    bytes_.insert(bytes_.end(), x.begin(), x.end());
    return *this;
  }

  bytes whole() const {
    auto result = bytes_;
    const auto length = result.size() - rtps_header_bytes - 4;
    result[rtps_header_bytes + (little_endian_ ? 2 : 3)] =
        static_cast<std::uint8_t>(length);
    return result;
  }

private:
  message& number(std::uint32_t x, unsigned size) {
    for (unsigned i = 0; i < size; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(
          x >> 8 * (little_endian_ ? i : size - 1 - i)));
    return *this;
  }

  bool little_endian_;
  bytes bytes_;
};

constexpr std::int64_t used_before = 5000;
const auto self = server_prefix(3);

std::shared_ptr<number_reserve> second_life() {
  auto result = std::make_shared<number_reserve>();
  result->begin_life();
  result->use_sequence(used_before - number_reserve::sequence_block);
  return result;
}

/// Big-endian, as participants are named.
const bytes pdp_writer{0, 1, 0, 0xc2};
const bytes pdp_reader{0, 1, 0, 0xc7};

bytes acknack(bool little_endian, std::int64_t base,
              const std::vector<std::uint32_t>& words, std::uint32_t bits) {
  message result{submessage_kind::acknack, little_endian};
  result.raw(pdp_reader).raw(pdp_writer).sequence(base).u32(bits);
  for (const auto x : words)
    result.u32(x);
  return result.u32(9).whole();
}

bytes identity(bool little_endian, const guid_prefix& whose,
               std::int64_t number) {
  message result{submessage_kind::data, little_endian};
  result.u16(0x800f).u16(24).raw({whose.begin(), whose.end()});
  result.raw(pdp_writer).sequence(number).u16(1).u16(0);
  const auto all = result.whole();
  return {all.begin() + rtps_header_bytes + 4, all.end()};
}

bytes data(bool little_endian, const guid_prefix& whose, std::int64_t number) {
  return message{submessage_kind::data, little_endian,
                 submessage_flag::inline_qos}
      .u16(0)
      .u16(16)
      .raw(pdp_reader)
      .raw(pdp_writer)
      .sequence(number)
      .raw(identity(little_endian, whose, number))
      .whole();
}

} // namespace

TEST_CASE("what a later life numbers is above what the earlier one has used") {
  const bool order = GENERATE(true, false);
  const number_shift shift{self, second_life()};
  auto said = data(order, self, 2);
  shift.let_out(said.data(), said.size());
  CHECK(said == data(order, self, used_before + 2));
}

TEST_CASE("of a sample of somebody else only the writer's number is shifted") {
  const bool order = GENERATE(true, false);
  const number_shift shift{self, second_life()};
  const auto other = server_prefix(4);
  auto said = data(order, other, 2);
  shift.let_out(said.data(), said.size());
  auto expected = data(order, other, 2);
  const auto shifted = data(order, other, used_before + 2);
  std::copy_n(shifted.begin(), rtps_header_bytes + 4 + 20, expected.begin());
  CHECK(said == expected);
}

TEST_CASE("counts go on over all writers and lives") {
  const bool order = GENERATE(true, false);
  const auto reserve = second_life();
  const number_shift shift{self, reserve};
  const auto before = reserve->next_count();
  const auto heartbeat = [&](std::int64_t first, std::int64_t last,
                             std::uint32_t count) {
    return message{submessage_kind::heartbeat, order}
        .raw(pdp_reader)
        .raw(pdp_writer)
        .sequence(first)
        .sequence(last)
        .u32(count)
        .whole();
  };
  for (std::uint32_t i = 1; i <= 3; ++i) {
    auto said = heartbeat(1, 0, 1);
    shift.let_out(said.data(), said.size());
    CHECK(said == heartbeat(used_before + 1, used_before, before + i));
  }
  auto said = acknack(order, 17, {0x80000000}, 1);
  shift.let_out(said.data(), said.size());
  auto expected = acknack(order, 17, {0x80000000}, 1);
  // The count is the last word; 1024 is far from filling its lowest byte alone.
  CHECK(bytes(said.begin(), said.end() - 4)
        == bytes(expected.begin(), expected.end() - 4));
  CHECK(said != expected);
}

TEST_CASE("who has heard an earlier life has got nothing of this one") {
  const bool order = GENERATE(true, false);
  const number_shift shift{self, second_life()};
  auto expects_old = acknack(order, used_before - 10, {}, 0);
  shift.take_in(expects_old.data(), expects_old.size());
  CHECK(expects_old == acknack(order, 1, {}, 0));
  // Asks for two of the earlier life and for the first of this one.
  auto asks = acknack(order, used_before - 1, {0xe0000000}, 3);
  shift.take_in(asks.data(), asks.size());
  CHECK(asks == acknack(order, 1, {0x80000000}, 3));
}

TEST_CASE("who has heard this life is understood") {
  const bool order = GENERATE(true, false);
  const number_shift shift{self, second_life()};
  auto asks = acknack(order, used_before + 4, {0x12345678, 0x9abcdef0}, 60);
  shift.take_in(asks.data(), asks.size());
  CHECK(asks == acknack(order, 4, {0x12345678, 0x9abcdef0}, 60));
  auto wants_all = acknack(order, 0, {}, 0);
  shift.take_in(wants_all.data(), wants_all.size());
  CHECK(wants_all == acknack(order, 0, {}, 0));
  // A bit for each number over a border of words.
  auto over = acknack(order, used_before - 31, {0, 0xc0000000}, 40);
  shift.take_in(over.data(), over.size());
  CHECK(over == acknack(order, 1, {0xc0000000, 0}, 40));
}

TEST_CASE("a gap of a later life is shifted whole") {
  const bool order = GENERATE(true, false);
  const number_shift shift{self, second_life()};
  const auto gap = [&](std::int64_t first, std::int64_t base) {
    return message{submessage_kind::gap, order}
        .raw(pdp_reader)
        .raw(pdp_writer)
        .sequence(first)
        .sequence(base)
        .u32(0)
        .whole();
  };
  auto said = gap(3, 8);
  shift.let_out(said.data(), said.size());
  CHECK(said == gap(used_before + 3, used_before + 8));
}

TEST_CASE("no message that comes is too short to be shifted back") {
  const number_shift shift{self, second_life()};
  const auto whole = acknack(true, used_before - 1, {0xe0000000}, 3);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    bytes part{whole.begin(), whole.begin() + static_cast<long>(size)};
    shift.take_in(part.data(), part.size());
    shift.let_out(part.data(), part.size());
  }
}
