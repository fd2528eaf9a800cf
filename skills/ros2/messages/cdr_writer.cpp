#include "roscell/ros2/detail/cdr_writer.hpp"

#include <limits>

namespace roscell::ros2 {

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

} // namespace roscell::ros2
