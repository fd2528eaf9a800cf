#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace roscell::test {

/// Converts to anything; what it converts to is never looked at.
struct any_value {
  template <class T>
  operator T() const;
};

template <class T, class Indices, class = void>
struct takes_values : std::false_type {};

template <class T, size_t... Is>
struct takes_values<T, std::index_sequence<Is...>,
                    std::void_t<decltype(T{(void(Is), any_value{})...})>>
    : std::true_type {};

/// How many members an aggregate really has, whatever its `fields()` say.
template <class T, size_t N = 32>
constexpr size_t member_count() {
  if constexpr (N == 0)
    return 0;
  else if constexpr (takes_values<T, std::make_index_sequence<N>>::value)
    return N;
  else
    return member_count<T, N - 1>();
}

} // namespace roscell::test
