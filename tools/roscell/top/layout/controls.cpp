#include "tools/roscell/top/layout/controls.hpp"

#include <algorithm>

namespace roscell::cli::top {

namespace {

const table& list_of(const controls& now, const surroundings& around) {
  return around.lists.at(now.list);
}

void select(controls& now, const surroundings& around, size_t index) {
  const auto& rows = list_of(now, around).rows;
  if (!rows.empty())
    now.lists.at(now.list).selected =
        rows[std::min(index, rows.size() - 1)].front().text;
}

size_t less(size_t x, size_t y) {
  return x - std::min(x, y);
}

/// Where a key leads from a place among so many; the same place for a key that
/// does not move.
size_t moved(size_t from, const key& pressed, size_t page, size_t last) {
  switch (pressed.name) {
  case key_name::up:
    return less(from, 1);
  case key_name::down:
    return std::min(last, from + 1);
  case key_name::page_up:
    return less(from, page);
  case key_name::page_down:
    return std::min(last, from + page);
  case key_name::home:
    return 0;
  case key_name::end:
    return last;
  default:
    return from;
  }
}

void open(controls& now, top_page where) {
  now.where = where;
  now.text_filter.clear();
  now.scroll = 0;
  now.at_end = where == top_page::log || where == top_page::events;
}

/// The details or the log of what is selected.
void open_selected(controls& now, const surroundings& around, top_page where) {
  const auto& rows = list_of(now, around).rows;
  const auto kind = listed_kinds.at(now.list);
  if (rows.empty()) {
    now.note = "nothing is selected";
    return;
  }
  if (where == top_page::log && kind != thing_kind::instance) {
    now.note = "only instances have a log: Tab leads to them";
    return;
  }
  const auto& selected = now.lists.at(now.list).selected;
  now.subject = {
      kind, rows[selected_index(list_of(now, around), selected)].front().text};
  open(now, where);
}

void sort_by_next(controls& now, const surroundings& around) {
  const auto& list = list_of(now, around);
  auto& column = now.lists.at(now.list).order.column;
  const auto next = column_of(list, column).value_or(0) + 1;
  column = list.columns[next % list.columns.size()].name;
}

void type(controls& now, const key& pressed) {
  auto& filter = filter_of(now);
  switch (pressed.name) {
  case key_name::text:
    filter += pressed.text;
    break;
  case key_name::backspace:
    // A character may be several bytes.
    while (!filter.empty() && (filter.back() & 0xc0) == 0x80)
      filter.pop_back();
    if (!filter.empty())
      filter.pop_back();
    break;
  case key_name::escape:
    filter.clear();
    now.typing = false;
    break;
  case key_name::enter:
    now.typing = false;
    break;
  default:
    break;
  }
}

/// Keys that mean the same everywhere.
bool press_anywhere(controls& now, const key& pressed) {
  if (pressed.text == "/")
    now.typing = true;
  else if (pressed.text == "?")
    open(now, top_page::help);
  else if (pressed.text == "e")
    open(now, top_page::events);
  else
    return false;
  return true;
}

void press_in_text(controls& now, const key& pressed,
                   const surroundings& around) {
  const auto last = less(around.lines, around.page);
  const bool leaves = pressed.name == key_name::escape
                      || pressed.name == key_name::backspace
                      || pressed.text == "q";
  // Escape takes the filter away first.
  if (pressed.name == key_name::escape && !now.text_filter.empty())
    now.text_filter.clear();
  else if (leaves)
    open(now, top_page::overview);
  else {
    const auto from = now.at_end ? last : std::min(now.scroll, last);
    now.scroll = moved(from, pressed, around.page, last);
    const bool grows =
        now.where == top_page::log || now.where == top_page::events;
    now.at_end = grows && now.scroll == last;
  }
}

void press_in_lists(controls& now, const key& pressed,
                    const surroundings& around) {
  constexpr auto count = listed_kinds.size();
  auto& choice = now.lists.at(now.list);
  const auto& shown = list_of(now, around);
  if (pressed.text == "q")
    now.left = true;
  else if (pressed.text == "s")
    sort_by_next(now, around);
  else if (pressed.text == "S")
    choice.order.backwards = !choice.order.backwards;
  else if (pressed.text == "l")
    open_selected(now, around, top_page::log);
  else if (pressed.name == key_name::enter)
    open_selected(now, around, top_page::details);
  else if (pressed.name == key_name::tab)
    now.list = (now.list + 1) % count;
  else if (pressed.name == key_name::back_tab)
    now.list = (now.list + count - 1) % count;
  else if (pressed.name == key_name::escape)
    now.filter.clear();
  else
    select(now, around,
           moved(selected_index(shown, choice.selected), pressed, around.page,
                 less(shown.rows.size(), 1)));
}

} // namespace

std::string& filter_of(controls& now) {
  return now.where == top_page::overview ? now.filter : now.text_filter;
}

const std::string& filter_of(const controls& now) {
  return now.where == top_page::overview ? now.filter : now.text_filter;
}

size_t selected_index(const table& shown, const std::string& selected) {
  const auto found =
      std::find_if(shown.rows.begin(), shown.rows.end(), [&](const auto& row) {
        return row.front().text == selected;
      });
  return found == shown.rows.end()
             ? 0
             : static_cast<size_t>(found - shown.rows.begin());
}

void press(controls& now, const key& pressed, const surroundings& around) {
  now.note.clear();
  if (now.typing)
    type(now, pressed);
  else if (press_anywhere(now, pressed))
    return;
  else if (now.where == top_page::overview)
    press_in_lists(now, pressed, around);
  else
    press_in_text(now, pressed, around);
}

} // namespace roscell::cli::top
