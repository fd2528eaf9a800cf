#include "actors/edge/dds/rtps/discovery_wire.hpp"

#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <algorithm>
#include <string_view>

namespace roscell {

namespace {

namespace parameter = parameter_id;

/// The bit of a participant's endpoint set that takes other participants' data.
constexpr std::uint8_t participant_detector = 2;

/// The sizes of the values that have one. Fast DDS releases a list twice when
/// one of them is wrong.
struct fixed_size {
  std::uint16_t id;
  std::uint16_t bytes;
};

constexpr std::array<fixed_size, 30> fixed_sizes{{
    {0x0002, 8},  {0x0004, 8},  {0x0006, 4},  {0x0015, 4},  {0x0016, 4},
    {0x001a, 12}, {0x001b, 12}, {0x001d, 4},  {0x001e, 28}, {0x001f, 4},
    {0x0021, 8},  {0x0023, 8},  {0x0025, 4},  {0x0027, 8},  {0x002b, 8},
    {0x002f, 24}, {0x0030, 24}, {0x0031, 24}, {0x0032, 24}, {0x0033, 24},
    {0x0043, 4},  {0x0048, 24}, {0x0050, 16}, {0x0058, 4},  {0x005a, 16},
    {0x0060, 4},  {0x0070, 16}, {0x0071, 4},  {0x8002, 16}, {0x800f, 24},
}};

/// Fast DDS's limit for names, and with the zero.
constexpr std::uint32_t max_text_bytes = 256;

/// ROS 2 sends two or three.
constexpr std::uint32_t max_properties = 64;
constexpr std::uint32_t max_partitions = 64;

/// A CDR string with its padding. Its bytes without the final zero, or a null
/// view when there is none.
std::string_view take_text(wire_cursor& in) {
  auto length = in.u32();
  if (length == 0 || length > max_text_bytes)
    return {};
  auto text = in.take(length);
  auto aligned = in.skip((4 - length % 4) % 4);
  if (!text.good() || !aligned || text.position()[length - 1] != 0)
    return {};
  return {reinterpret_cast<const char*>(text.position()), length - 1};
}

bool skip_text(wire_cursor& in) {
  return take_text(in).data() != nullptr;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.size() < 8 && text.front() >= '0'
         && text.front() <= '9'
         && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

bool is_property_list(wire_cursor in) {
  auto count = in.u32();
  if (count > max_properties)
    return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    auto name = take_text(in);
    auto value = take_text(in);
    if (name.data() == nullptr || value.data() == nullptr)
      return false;
    // Fast DDS compares up to the first zero, and converts what follows.
    if (name.substr(0, name.find('\0')) == "DS_VERSION" && !is_number(value))
      return false;
  }
  return in.at_end();
}

bool is_partition(wire_cursor in) {
  auto count = in.u32();
  if (count > max_partitions)
    return false;
  for (std::uint32_t i = 0; i < count; ++i)
    if (!skip_text(in))
      return false;
  return in.at_end();
}

bool is_text(wire_cursor in) {
  return skip_text(in) && in.at_end();
}

/// A sequence of items of `item_bytes`, which may be followed by padding.
bool is_sequence(wire_cursor in, std::size_t item_bytes) {
  std::size_t count = in.u32();
  return in.good() && count <= in.size() / item_bytes;
}

bool has_right_size(std::uint16_t id, const wire_cursor& value) {
  for (auto& x : fixed_sizes)
    if (x.id == id)
      return value.size() == x.bytes;
  return true;
}

enum class verdict { safe, hide, refuse };

/// `value` is a set of four bytes.
void hide_detector(const wire_cursor& value) {
  auto lowest = value.is_little_endian() ? 0 : 3;
  value.position()[lowest] &= static_cast<std::uint8_t>(~participant_detector);
}

verdict if_true(bool good) {
  return good ? verdict::safe : verdict::refuse;
}

verdict judge(std::uint16_t id, const wire_cursor& value) {
  switch (id) {
  case parameter::topic_name:
  case parameter::type_name:
  case parameter::entity_name:
    return if_true(is_text(value));
  case parameter::user_data:
  case parameter::group_data:
  case parameter::topic_data:
    return if_true(is_sequence(value, 1));
  case parameter::data_representation:
    return if_true(is_sequence(value, 2));
  case parameter::data_sharing:
    return if_true(is_sequence(value, 8));
  case parameter::partition:
    return if_true(is_partition(value));
  case parameter::property_list:
    return if_true(is_property_list(value));
  case parameter::content_filter:
  case parameter::type_id:
  case parameter::type_object:
  case parameter::type_information:
  case parameter::identity_token:
  case parameter::permissions_token:
  case parameter::data_tags:
  case parameter::identity_status_token:
    return verdict::hide;
  default:
    return if_true(has_right_size(id, value));
  }
}

} // namespace

bool wire_cursor::skip(std::size_t count) {
  good_ = good_ && count <= size();
  at_ = good_ ? at_ + count : end_;
  return good_;
}

wire_cursor wire_cursor::take(std::size_t count) {
  auto* first = at_;
  auto result = *this;
  skip(count);
  result.good_ = good_;
  result.at_ = good_ ? first : end_;
  result.end_ = good_ ? first + count : end_;
  return result;
}

std::uint8_t wire_cursor::u8() {
  auto* at = at_;
  return skip(1) ? *at : std::uint8_t{0};
}

std::uint16_t wire_cursor::u16() {
  unsigned first = u8();
  unsigned second = u8();
  return static_cast<std::uint16_t>(little_endian_ ? first | second << 8
                                                   : first << 8 | second);
}

std::uint32_t wire_cursor::u32() {
  std::uint32_t first = u16();
  std::uint32_t second = u16();
  return little_endian_ ? first | second << 16 : first << 16 | second;
}

std::uint32_t wire_cursor::big_endian_u32() {
  std::uint32_t result = 0;
  for (int i = 0; i < 4; ++i)
    result = result << 8 | u8();
  return result;
}

std::int64_t wire_cursor::sequence_number() {
  auto high = static_cast<std::uint64_t>(u32());
  return static_cast<std::int64_t>(high << 32 | u32());
}

bool parameter_guard::make_safe(wire_cursor& in) {
  const auto own_key = what_ == described_entity::participant
                           ? parameter::participant_guid
                           : parameter::endpoint_guid;
  while (in.good()) {
    auto* at = in.position();
    auto id = in.u16();
    auto length = in.u16();
    if (id == parameter::sentinel)
      return in.good();
    auto value = in.take(length);
    if (!in.good() || length % 4 != 0)
      return false;
    auto found = judge(id, value);
    if (found == verdict::refuse
        || ((id == own_key || id == parameter::key_hash) && !is_key(value)))
      return false;
    if (found == verdict::hide)
      std::fill_n(at, 2, std::uint8_t{parameter::padding});
    if (id == parameter::builtin_endpoint_set && how_ == arrival::multicast)
      hide_detector(value);
  }
  return false;
}

/// A GUID of the right kind of entity (RTPS 2.3, 9.3.1.2), the same each time.
bool parameter_guard::is_key(wire_cursor value) {
  std::array<std::uint8_t, 16> key{};
  std::copy_n(value.position(), key.size(), key.begin());
  value.skip(12);
  auto entity = value.big_endian_u32();
  auto kind = entity & 0x3f;
  auto right = what_ == described_entity::participant ? entity == 0x000001c1
               : what_ == described_entity::writer    ? kind == 2 || kind == 3
                                                      : kind == 4 || kind == 7;
  if (!right || (has_key_ && key != key_))
    return false;
  has_key_ = true;
  key_ = key;
  return true;
}

} // namespace roscell
