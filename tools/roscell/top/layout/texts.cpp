#include "tools/roscell/top/layout/texts.hpp"

#include "tools/roscell/client/event_text.hpp"
#include "tools/roscell/view/describe/describe_view.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <sstream>

namespace roscell::cli::top {

namespace {

constexpr auto help = R"(  Up Down PgUp PgDn Home End   move
  Tab                          nodes, tasks, instances
  Enter                        details of what is selected
  l                            the log of an instance, as it grows
  e                            events, as they happen
  s  S                         sort by the next column; the other way round
  /                            filter: what does not contain the text is hidden
  Esc                          no filter; back to the lists
  q                            back to the lists; quit, as Ctrl-C does
  Ctrl-Z                       stop, fg goes on; nothing within `roscell shell`

  A bar is a node's resource, and behind it stands what is used of it.
    █ #   used by other programs        · .   free
    ▒ +   reserved by instances         90 % and more have another colour

  The line below the first says what is wrong in the cell, the one above the
  keys what has happened last. A list is sorted by the column with ^ or v.
  What the node has measured and what skills say is asked for every two
  seconds; all else is told by events.)";

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in{text};
  for (std::string x; std::getline(in, x);)
    result.push_back(x);
  return result;
}

std::vector<std::string> details_lines(const scene& shown,
                                       const frame_style& style) {
  const auto& known = shown.known.known();
  const auto& what = shown.now.subject;
  const auto all = things_of(known);
  const bool is_there =
      std::any_of(all.begin(), all.end(), [&](const known_thing& x) {
        return x.kind == what.kind && x.name == what.name;
      });
  if (!is_there)
    return {"it is gone; `e` shows what has happened"};
  view_style how;
  how.text.width = style.width;
  how.now_unix_ms = style.now_unix_ms;
  return lines_in(describe_view(known, what, "", how));
}

std::vector<std::string> event_lines(const scene& shown,
                                     const frame_style& style) {
  std::vector<std::string> result;
  for (const auto& e : shown.known.known().events)
    result.push_back(event_line(e, style.width));
  return result;
}

open_text whole_text(const scene& shown, const frame_style& style) {
  const auto& name = shown.now.subject.name;
  switch (shown.now.where) {
  case top_page::details:
    return {to_string(shown.now.subject.kind) + " " + name,
            details_lines(shown, style)};
  case top_page::log:
    return {"log of " + name, shown.log};
  case top_page::events:
    return {event_heading(style.width), event_lines(shown, style)};
  default:
    return {"keys", lines_in(help)};
  }
}

} // namespace

open_text text_of(const scene& shown, const frame_style& style) {
  auto result = whole_text(shown, style);
  auto& lines = result.lines;
  lines.erase(std::remove_if(lines.begin(), lines.end(),
                             [&](const std::string& x) {
                               return !contains_words(x, shown.now.text_filter);
                             }),
              lines.end());
  return result;
}

} // namespace roscell::cli::top
