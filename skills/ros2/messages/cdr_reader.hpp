#pragma once

#include "skills/ros2/messages/cdr_error.hpp"
#include "skills/ros2/messages/fields.hpp"

#include <fastcdr/Cdr.h>

#include <string>
#include <string_view>
#include <vector>

/// INTERNAL to this folder.
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
    return std::apply(
        [](auto... f) {
          return (least_bytes<typename decltype(f)::type>() + ... + 0);
        },
        T::fields());
  else // A length.
    return 4;
}

/// Reads one message out of bytes that may lie.
class cdr_reader {
public:
  /// Throws cdr_error unless `payload` begins as plain CDR does.
  explicit cdr_reader(std::string_view payload);

  template <class T>
  void read(T& x) {
    if constexpr (is_message<T>::value)
      std::apply([&](auto... f) { (read_field(f.name, x.*f.member), ...); },
                 T::fields());
    else
      read_scalar([&] { cdr_ >> x; });
  }

  void read(std::string& x);

  template <class T>
  void read(std::vector<T>& x) {
    x.resize(read_count(least_bytes<T>()));
    read_items(x);
  }

  template <class T, std::size_t N>
  void read(std::array<T, N>& x) {
    read_items(x);
  }

  template <class T>
  void read_field(const char* name, T& x) {
    read_inside(name, [&] { read(x); });
  }

  /// A field that is a sequence of bytes, where it lies.
  std::string_view read_bytes(const char* name);

  /// Throws cdr_error if more than padding is left.
  void finish();

private:
  template <class F>
  void read_inside(const char* name, F&& f) {
    try {
      f();
    } catch (const cdr_error& e) {
      throw inside(name, e);
    }
  }

  template <class Items>
  void read_items(Items& items) {
    std::size_t i = 0;
    try {
      for (; i < items.size(); ++i)
        read(items[i]);
    } catch (const cdr_error& e) {
      throw inside('[' + std::to_string(i) + ']', e);
    }
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

  static cdr_error inside(const std::string& outer, const cdr_error& e);
  std::size_t left() const;
  std::size_t read_count(std::size_t least_bytes_of_item);
  std::string_view take(std::size_t count);

  const std::size_t size_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

} // namespace roscell::ros2
