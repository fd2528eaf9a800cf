#pragma once

#include "tools/roscell/top/layout/controls.hpp"
#include "tools/roscell/top/terminal/signals.hpp"

#include <cstddef>
#include <cwchar>
#include <optional>
#include <string>
#include <vector>

namespace roscell::cli::top {

/// The terminal as a full screen, by ncurses, which sends only what differs
/// from what is there already. Leaves the terminal as it was.
class screen {
public:
  /// Throws command_error if this terminal cannot be one.
  explicit screen(bool with_colours);
  ~screen();

  screen(const screen&) = delete;
  screen& operator=(const screen&) = delete;

  size_t width() const;
  size_t height() const;

  /// Whether it can show more than ASCII.
  bool utf8() const {
    return utf8_;
  }

  void draw(const std::vector<line>& lines);

  /// The next key that was pressed, without a wait.
  std::optional<key> take_key();

  /// The terminal has another size.
  void adopt_size();

  /// The terminal is for others, until `resume`.
  void suspend();
  void resume();

  /// Everything is sent again at the next drawing.
  void forget();

private:
  void begin_colours();
  void draw_line(int row, const line& x);
  unsigned long attributes_of(look how) const;

  /// What of a text the terminal can show, in as many columns.
  std::string shown_text(const std::string& text) const;

  crash_guard guard_;
  bool utf8_ = false;
  bool colours_ = false;
};

// INTERNAL to the screen: keys as ncurses tells them. Nothing for those that
// mean nothing to us.

/// A key that types no character.
std::optional<key> special_key(wint_t code);

/// A character, or what terminals send as one, such as Tab.
std::optional<key> typed_key(wint_t code);

} // namespace roscell::cli::top
