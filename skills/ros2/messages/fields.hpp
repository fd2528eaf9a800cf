#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

/// One list of fields per message, in the order of its ROS definition, from
/// which equality, writing and reading are all derived. A message says
///
///     static constexpr auto fields() {
///       return std::make_tuple(named("sec", &time::sec), ...);
///     }
namespace roscell::ros2 {

template <class Struct, class Member>
struct field {
  using type = Member;
  const char* name;
  Member Struct::*member;
};

template <class S, class M>
constexpr auto named(const char* name, M S::*member) {
  return field<S, M>{name, member};
}

template <class T, class = void>
struct is_message : std::false_type {};

template <class T>
struct is_message<T, std::void_t<decltype(T::fields())>> : std::true_type {};

template <class T, class = std::enable_if_t<is_message<T>::value>>
bool operator==(const T& x, const T& y) {
  return std::apply(
      [&](const auto&... f) { return ((x.*f.member == y.*f.member) && ...); },
      T::fields());
}

template <class T, class = std::enable_if_t<is_message<T>::value>>
bool operator!=(const T& x, const T& y) {
  return !(x == y);
}

} // namespace roscell::ros2
