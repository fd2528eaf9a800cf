#pragma once

#include <cstddef>
#include <limits>
#include <type_traits>

/// One list of fields per message, in the order of its definition, from which
/// equality, writing and reading are all derived. A message says
///
///     template <class Visit>
///     static constexpr auto fields(Visit visit) {
///       return visit(ros2::named("sec", &time::sec), ...);
///     }
///
/// It is a template, and no tuple, so that who only includes a message does not
/// pay for the lists of all.
namespace roscell::ros2 {

inline constexpr auto unbounded = std::numeric_limits<std::size_t>::max();

/// How long a field may be by its definition.
struct bounds {
  std::size_t items = unbounded; ///< Of a sequence.
  std::size_t text = unbounded;  ///< Bytes of a string, or of each of them.
};

template <class Struct, class Member>
struct field {
  using type = Member;
  const char* name;
  Member Struct::*member;
  bounds most;
};

template <class S, class M>
constexpr auto named(const char* name, M S::*member, bounds most = {}) {
  return field<S, M>{name, member, most};
}

template <class T, class = void>
struct is_message : std::false_type {};

template <class T>
struct is_message<T, std::void_t<decltype(T::type_name)>> : std::true_type {};

template <class T, class = std::enable_if_t<is_message<T>::value>>
bool operator==(const T& x, const T& y) {
  return T::fields(
      [&](const auto&... f) { return ((x.*f.member == y.*f.member) && ...); });
}

template <class T, class = std::enable_if_t<is_message<T>::value>>
bool operator!=(const T& x, const T& y) {
  return !(x == y);
}

} // namespace roscell::ros2
