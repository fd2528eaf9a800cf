#include "tools/roscell/top/terminal/keys.hpp"

#include <cwchar>
#include <string>

// As macros its names would replace those of everybody else.
#define NCURSES_NOMACROS 1
#define NCURSES_WIDECHAR 1
#include <ncurses.h>

namespace roscell::cli::top {

namespace {

std::optional<key_name> name_of(wint_t code) {
  switch (code) {
  case KEY_UP:
    return key_name::up;
  case KEY_DOWN:
    return key_name::down;
  case KEY_PPAGE:
    return key_name::page_up;
  case KEY_NPAGE:
    return key_name::page_down;
  case KEY_HOME:
    return key_name::home;
  case KEY_END:
    return key_name::end;
  case KEY_BTAB:
    return key_name::back_tab;
  case KEY_ENTER:
    return key_name::enter;
  case KEY_BACKSPACE:
    return key_name::backspace;
  default:
    return std::nullopt;
  }
}

} // namespace

std::optional<key> special_key(wint_t code) {
  const auto name = name_of(code);
  return name ? std::optional<key>{key{*name, {}}} : std::nullopt;
}

std::optional<key> typed_key(wint_t code) {
  switch (code) {
  case L'\t':
    return key{key_name::tab, {}};
  case L'\r':
  case L'\n':
    return key{key_name::enter, {}};
  case 0x1b:
    return key{key_name::escape, {}};
  case 0x08:
  case 0x7f:
    return key{key_name::backspace, {}};
  default:
    break;
  }
  std::string bytes(MB_CUR_MAX, '\0');
  std::mbstate_t state{};
  const auto count =
      std::wcrtomb(bytes.data(), static_cast<wchar_t>(code), &state);
  if (code < 0x20 || count == static_cast<size_t>(-1))
    return std::nullopt;
  bytes.resize(count);
  return key{key_name::text, bytes};
}

} // namespace roscell::cli::top
