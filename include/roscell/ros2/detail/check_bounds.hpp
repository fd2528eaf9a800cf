#pragma once

#include "roscell/ros2/cdr_error.hpp"
#include "roscell/ros2/fields.hpp"

#include <array>
#include <string>
#include <vector>

/// INTERNAL: for what is made from definitions of messages.
namespace roscell::ros2 {

/// Throws cdr_error when a value is longer than its definition allows.
template <class T>
void check_bounds(const T&, const bounds&) {
  // Has no length, or one that its type fixes.
}

inline void check_bounds(const std::string& x, const bounds& most) {
  if (x.size() > most.text)
    throw cdr_error("", "its " + std::to_string(x.size())
                            + " bytes are more than the "
                            + std::to_string(most.text) + " of its definition");
}

template <class T>
void check_bounds(const std::vector<T>& x, const bounds& most) {
  if (x.size() > most.items)
    throw cdr_error(
        "", "its " + std::to_string(x.size()) + " items are more than the "
                + std::to_string(most.items) + " of its definition");
  if constexpr (std::is_same_v<T, std::string>)
    for (const auto& text : x)
      check_bounds(text, most);
}

template <std::size_t N>
void check_bounds(const std::array<std::string, N>& x, const bounds& most) {
  for (const auto& text : x)
    check_bounds(text, most);
}

} // namespace roscell::ros2
