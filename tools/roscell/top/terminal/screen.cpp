#include "tools/roscell/top/terminal/screen.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <cwchar>
#include <string>

// As macros its names would replace those of everybody else.
#define NCURSES_NOMACROS 1
#define NCURSES_WIDECHAR 1
#include <ncurses.h>

// Its header, <term.h>, has macros such as `lines` and `tab`.
extern "C" char* tigetstr(const char* name);

namespace roscell::cli::top {

namespace {

/// So long a key that begins with Escape may take, in milliseconds.
constexpr int escape_patience = 25;

enum pair : short { green = 1, yellow, red, blue, cyan };

[[noreturn]] void refuse_terminal() {
  const auto* term = std::getenv("TERM");
  throw command_error{exit_usage,
                      "a terminal of the kind '"
                          + std::string{term == nullptr ? "" : term}
                          + "' cannot be a full screen",
                      "set TERM to what it is, or use `roscell tasks --watch`"};
}

/// A capability of this kind of terminal; empty if it has not got it.
const char* capability(const char* name) {
  const auto* text = tigetstr(name);
  const bool is_missing =
      text == nullptr || text == reinterpret_cast<const char*>(-1);
  return is_missing ? "" : text;
}

} // namespace

screen::screen(bool with_colours) {
  std::setlocale(LC_CTYPE, "");
  utf8_ = std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
  if (newterm(nullptr, stdout, stdin) == nullptr)
    refuse_terminal();
  if (*capability("cup") == '\0' || *capability("clear") == '\0') {
    endwin();
    refuse_terminal();
  }
  for (const auto* name : {"sgr0", "cnorm", "rmkx", "rmcup"})
    crash_guard::remember_farewell(capability(name));
  cbreak();
  noecho();
  nonl();
  set_escdelay(escape_patience);
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  curs_set(0);
  if (with_colours)
    begin_colours();
}

screen::~screen() {
  suspend();
}

void screen::begin_colours() {
  if (!has_colors() || start_color() == ERR)
    return;
  const short background = use_default_colors() == OK ? -1 : COLOR_BLACK;
  init_pair(green, COLOR_GREEN, background);
  init_pair(yellow, COLOR_YELLOW, background);
  init_pair(red, COLOR_RED, background);
  init_pair(blue, COLOR_BLUE, background);
  init_pair(cyan, COLOR_CYAN, background);
  colours_ = true;
}

size_t screen::width() const {
  return static_cast<size_t>(std::max(1, getmaxx(stdscr)));
}

size_t screen::height() const {
  return static_cast<size_t>(std::max(1, getmaxy(stdscr)));
}

unsigned long screen::attributes_of(look how) const {
  const auto coloured = [this](pair x, unsigned long otherwise) {
    return colours_ ? static_cast<unsigned long>(COLOR_PAIR(x)) : otherwise;
  };
  switch (how) {
  case look::strong:
    return A_BOLD;
  case look::faint:
    return A_DIM;
  case look::heading:
    return A_REVERSE;
  case look::good:
    return coloured(green, A_NORMAL);
  case look::busy:
    return coloured(yellow, A_UNDERLINE);
  case look::bad:
    return coloured(red, A_BOLD) | A_BOLD;
  case look::others:
    return coloured(blue, A_NORMAL);
  case look::reserved:
    return coloured(cyan, A_NORMAL);
  default:
    return A_NORMAL;
  }
}

std::string screen::shown_text(const std::string& text) const {
  std::string result;
  std::mbstate_t state{};
  for (size_t at = 0; at < text.size();) {
    // The texts are UTF-8, whatever the terminal takes.
    size_t length = 1;
    while (at + length < text.size() && (text[at + length] & 0xc0) == 0x80)
      ++length;
    wchar_t wide = 0;
    const bool is_ascii = length == 1;
    const bool fits =
        is_ascii
        || (utf8_ && std::mbrtowc(&wide, &text[at], length, &state) == length
            && wcwidth(wide)
                   == static_cast<int>(display_width({&text[at], length})));
    if (fits)
      result.append(text, at, length);
    else {
      state = {};
      result += std::string(display_width({&text[at], length}),
                            text.compare(at, length, "…") == 0 ? '~' : '?');
    }
    at += length;
  }
  return result;
}

void screen::draw_line(int row, const line& x) {
  const unsigned long marked = x.selected ? A_REVERSE : A_NORMAL;
  wmove(stdscr, row, 0);
  for (const auto& part : x.spans) {
    const auto text = shown_text(part.text);
    wattrset(stdscr, static_cast<int>(attributes_of(part.how) | marked));
    waddnstr(stdscr, text.c_str(), static_cast<int>(text.size()));
  }
  wattrset(stdscr, A_NORMAL);
}

void screen::draw(const std::vector<line>& lines) {
  werase(stdscr);
  for (size_t i = 0; i < lines.size() && i < height(); ++i)
    draw_line(static_cast<int>(i), cut(lines[i], width()));
  wrefresh(stdscr);
}

std::optional<key> screen::take_key() {
  wint_t code = 0;
  for (int kind = OK; (kind = wget_wch(stdscr, &code)) != ERR;)
    if (auto known = kind == KEY_CODE_YES ? special_key(code) : typed_key(code))
      return known;
  return std::nullopt;
}

void screen::adopt_size() {
  winsize now{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &now) == 0 && now.ws_row > 0
      && now.ws_col > 0)
    resizeterm(now.ws_row, now.ws_col);
}

void screen::suspend() {
  // A terminal without a second screen goes on in the last line.
  wmove(stdscr, getmaxy(stdscr) - 1, 0);
  wclrtoeol(stdscr);
  wrefresh(stdscr);
  endwin();
}

void screen::resume() {
  reset_prog_mode();
  adopt_size();
  curs_set(0);
  forget();
}

void screen::forget() {
  clearok(stdscr, TRUE);
}

} // namespace roscell::cli::top
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
