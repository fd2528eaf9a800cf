#pragma once

#include "tools/roscell/top/layout/controls.hpp"

#include <cwchar>
#include <optional>

/// INTERNAL to the screen: keys as ncurses tells them. Nothing for those that
/// mean nothing to us.
namespace roscell::cli::top {

/// A key that types no character.
std::optional<key> special_key(wint_t code);

/// A character, or what terminals send as one, such as Tab.
std::optional<key> typed_key(wint_t code);

} // namespace roscell::cli::top
