#pragma once

#include "tools/roscell/top/layout/lists.hpp"

#include <array>
#include <string>

namespace roscell::cli::top {

enum class key_name {
  text, ///< What was typed.
  up,
  down,
  page_up,
  page_down,
  home,
  end,
  tab,
  back_tab,
  enter,
  escape,
  backspace,
};

struct key {
  key_name name = key_name::text;
  std::string text; ///< One character in UTF-8.
};

/// What is on the screen.
enum class top_page { overview, details, log, events, help };

/// What somebody has chosen in one of the lists.
struct list_choice {
  std::string selected; ///< Its name; empty, or gone: the first.
  list_order order;
};

struct controls {
  top_page where = top_page::overview;
  size_t list = 0; ///< That keys mean.
  std::array<list_choice, listed_kinds.size()> lists;
  std::string filter;      ///< Of the lists.
  std::string text_filter; ///< Of the text that is open.
  bool typing = false;     ///< Keys go into the filter of what is seen.
  known_thing subject;     ///< Of the details or the log.
  size_t scroll = 0;       ///< First line that is seen of a text.
  bool at_end = false;     ///< The end of the text is seen, also when it grows.
  std::string note;        ///< Answers the last key; empty: nothing to say.
  bool left = false;       ///< Nobody wants to look any more.
};

/// The filter of what is seen.
std::string& filter_of(controls& now);
const std::string& filter_of(const controls& now);

/// What is there to move in, when a key is pressed.
struct surroundings {
  const tables& lists; ///< As shown.
  size_t page = 1;     ///< Lines of the list, or of the text, that are seen.
  size_t lines = 0;    ///< Of the text.
};

/// Does what a key means.
void press(controls& now, const key& pressed, const surroundings& around);

/// Place of the selected thing; 0 if it is gone.
size_t selected_index(const table& shown, const std::string& selected);

} // namespace roscell::cli::top
