#include "roscell/ros2/detail/cdr_reader.hpp"
#include "roscell/ros2/detail/cdr_writer.hpp"
#include "roscell/ros2/stamp.hpp"

#include <limits>

namespace roscell::ros2 {

namespace {

using eprosima::fastcdr::Cdr;

/// Senders may fill a payload up to a multiple of 4.
constexpr std::size_t max_padding = 3;

/// Before the message: CDR_BE or CDR_LE, and two bytes without a meaning (RTPS
/// 2.3, 10.2.1.2).
std::string_view check_encapsulation(std::string_view payload) {
  if (payload.size() < 4 || payload[0] != 0 || (payload[1] & ~1) != 0)
    throw cdr_error("encapsulation", "this is no plain CDR");
  return payload;
}

} // namespace

cdr_reader::cdr_reader(std::string_view payload)
    : size_(check_encapsulation(payload).size()),
      // Fast CDR takes no constant bytes, but only writes when asked to.
      buffer_(const_cast<char*>(payload.data()), payload.size()),
      cdr_(buffer_, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR) {
  cdr_.read_encapsulation();
}

void cdr_reader::read(std::string& x) {
  // The count includes a final zero. Some write an empty string as nothing.
  auto text = take(read_count(1));
  if (!text.empty() && text.back() != '\0')
    throw cdr_error("", "the text does not end with a zero");
  x.assign(text.data(), text.empty() ? 0 : text.size() - 1);
}

std::string_view cdr_reader::read_bytes(const char* name) {
  std::string_view result;
  in_field(name, [&] { result = take(read_count(1)); });
  return result;
}

void cdr_reader::finish() {
  if (left() > max_padding)
    throw cdr_error("", std::to_string(left())
                            + " bytes are left behind the last field");
}

std::size_t cdr_reader::left() const {
  return size_ - cdr_.getSerializedDataLength();
}

std::size_t cdr_reader::read_count(std::size_t least_bytes_of_item) {
  std::uint32_t count = 0;
  read_scalar([&] { cdr_ >> count; });
  if (count > left() / least_bytes_of_item)
    throw cdr_error("", "its length " + std::to_string(count)
                            + " is too much for the " + std::to_string(left())
                            + " bytes that are left");
  return count;
}

std::string_view cdr_reader::take(std::size_t count) {
  std::string_view result{cdr_.getCurrentPosition(), count};
  if (count > 0) {
    // Fast CDR aligns what follows a byte that was read, but not a jump.
    char last = 0;
    cdr_.jump(count - 1);
    cdr_ >> last;
  }
  return result;
}

using eprosima::fastcdr::Cdr;

namespace {

constexpr std::size_t encapsulation_bytes = 4;

} // namespace

cdr_writer::cdr_writer() : cdr_(buffer_, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR) {
  cdr_.serialize_encapsulation();
}

void cdr_writer::write(const std::string& x) {
  // Fast CDR's own way would end the text at its first zero.
  write_count(x.size() + 1);
  cdr_.serializeArray(x.c_str(), x.size() + 1);
}

void cdr_writer::write(const std::vector<std::uint8_t>& x) {
  write_count(x.size());
  cdr_.serializeArray(x.data(), x.size());
}

void cdr_writer::write_count(std::size_t count) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw cdr_error("", std::to_string(count) + " items are too many");
  write_scalar(static_cast<std::uint32_t>(count));
}

/// Fast CDR skips its padding, and so would send what the memory held before.
void cdr_writer::pad(std::size_t alignment) {
  auto at = cdr_.getSerializedDataLength() - encapsulation_bytes;
  for (auto count = Cdr::alignment(at, alignment); count > 0; --count)
    cdr_ << '\0';
}

std::string_view cdr_writer::bytes() {
  return {buffer_.getBuffer(), cdr_.getSerializedDataLength()};
}

using namespace std::chrono;
using builtin_interfaces::time;

time to_time(system_clock::time_point when) {
  auto whole = floor<seconds>(when);
  return {static_cast<std::int32_t>(whole.time_since_epoch().count()),
          static_cast<std::uint32_t>(nanoseconds{when - whole}.count())};
}

system_clock::time_point to_time_point(const time& stamp) {
  return system_clock::time_point{duration_cast<system_clock::duration>(
      seconds{stamp.sec} + nanoseconds{stamp.nanosec})};
}

std::optional<time> stamp_of(std::string_view payload) {
  try {
    time result;
    cdr_reader{payload}.read(result);
    return result;
  } catch (const cdr_error&) {
    return std::nullopt;
  }
}

} // namespace roscell::ros2
