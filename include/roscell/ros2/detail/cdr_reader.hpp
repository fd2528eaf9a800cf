#pragma once

#include "roscell/ros2/detail/check_bounds.hpp"

#include <fastcdr/Cdr.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

/// INTERNAL: for what is made from definitions of messages.
namespace roscell::ros2 {

template <class T>
inline constexpr std::size_t extent = 0;

template <class T, std::size_t N>
inline constexpr std::size_t extent<std::array<T, N>> = N;

/// The fewest bytes that a value takes, padding not counted: what bounds the
/// number of items of a sequence.
template <class T>
constexpr std::size_t least_bytes() {
  if constexpr (std::is_arithmetic_v<T>)
    return sizeof(T);
  else if constexpr (extent<T> > 0)
    return extent<T> * least_bytes<typename T::value_type>();
  else if constexpr (is_message<T>::value)
    return T::fields([](auto... f) {
      return (least_bytes<typename decltype(f)::type>() + ... + 0);
    });
  else // A length.
    return 4;
}

/// What lies in a message as it lies in memory.
template <class T>
inline constexpr bool is_byte = std::is_integral_v<T> && sizeof(T) == 1
                                && !std::is_same_v<T, bool>;

/// Reads one message out of bytes that may lie.
class cdr_reader {
public:
  /// Throws cdr_error unless `payload` begins as plain CDR does.
  explicit cdr_reader(std::string_view payload);

  template <class T>
  void read(T& x) {
    if constexpr (is_message<T>::value)
      T::fields(
          [&](auto... f) { (read_field(f.name, x.*f.member, f.most), ...); });
    else
      read_scalar([&] { cdr_ >> x; });
  }

  void read(std::string& x);

  template <class T>
  void read(std::vector<T>& x) {
    x.resize(read_count(least_bytes<T>()));
    if constexpr (is_byte<T>) {
      auto bytes = take(x.size());
      std::copy(bytes.begin(), bytes.end(), x.begin());
    } else {
      read_items(x);
    }
  }

  template <class T, std::size_t N>
  void read(std::array<T, N>& x) {
    read_items(x);
  }

  template <class T>
  void read_field(const char* name, T& x, const bounds& most = {}) {
    in_field(name, [&] {
      read(x);
      check_bounds(x, most);
    });
  }

  /// A field that is a sequence of bytes, where it lies.
  std::string_view read_bytes(const char* name);

  /// Throws cdr_error if more than padding is left.
  void finish();

private:
  template <class Items>
  void read_items(Items& items) {
    std::size_t i = 0;
    try {
      for (; i < items.size(); ++i)
        read_item(items[i]);
    } catch (const cdr_error& e) {
      throw e.inside('[' + std::to_string(i) + ']');
    }
  }

  template <class T>
  void read_item(T& x) {
    read(x);
  }

  void read_item(std::vector<bool>::reference x) {
    auto value = false;
    read(value);
    x = value;
  }

  template <class F>
  void read_scalar(F&& f) {
    try {
      f();
    } catch (const eprosima::fastcdr::exception::NotEnoughMemoryException&) {
      throw cdr_error("", "the message ends before it");
    } catch (const eprosima::fastcdr::exception::Exception& e) {
      throw cdr_error("", e.what());
    }
  }

  std::size_t left() const;
  std::size_t read_count(std::size_t least_bytes_of_item);
  std::string_view take(std::size_t count);

  const std::size_t size_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

} // namespace roscell::ros2
