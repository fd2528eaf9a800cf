#pragma once

#include "roscell/ros2/detail/check_bounds.hpp"

#include <fastcdr/Cdr.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

/// INTERNAL: for what is made from definitions of messages.
namespace roscell::ros2 {

/// Writes one message, little endian, behind its encapsulation.
class cdr_writer {
public:
  cdr_writer();

  template <class T>
  void write(const T& x) {
    if constexpr (is_message<T>::value)
      T::fields(
          [&](auto... f) { (write_field(f.name, x.*f.member, f.most), ...); });
    else
      write_scalar(x);
  }

  void write(const std::string& x);
  void write(const std::vector<std::uint8_t>& x);

  template <class T>
  void write(const std::vector<T>& x) {
    write_count(x.size());
    for (const auto& item : x)
      write(item);
  }

  template <class T, std::size_t N>
  void write(const std::array<T, N>& x) {
    for (const auto& item : x)
      write(item);
  }

  /// Throws cdr_error when a sequence cannot be so long.
  void write_count(std::size_t count);

  /// What is written so far.
  std::string_view bytes();

private:
  template <class T>
  void write_field(const char* name, const T& x, const bounds& most) {
    in_field(name, [&] {
      check_bounds(x, most);
      write(x);
    });
  }

  template <class T>
  void write_scalar(T x) {
    pad(sizeof(T));
    cdr_ << x;
  }

  void pad(std::size_t alignment);

  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

} // namespace roscell::ros2
