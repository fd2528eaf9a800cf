#include "tools/roscell/top/layout/frame.hpp"

#include "client/known_cell.hpp"
#include "tools/roscell/view/describe/describe_view.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <sstream>

namespace roscell::cli::top {

namespace {

/// Lines around the lists: who and how, what is wrong; the last event, keys.
constexpr size_t lines_around = 4;
constexpr size_t least_list = 3;

std::string counted_text(size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

line link_text(const connection_state& state, int64_t now_unix_ms) {
  line result;
  if (state.live)
    put(result, "live", look::good);
  else if (state.since_unix_ms != 0)
    put(result,
        "NO ANSWER for " + format_since(state.since_unix_ms, now_unix_ms),
        look::bad);
  else
    put(result, "connecting", look::busy);
  return result;
}

/// Who is asked, and whether it answers.
line first_line(const scene& shown, const frame_style& style) {
  const auto& known = shown.known.known();
  const auto& cell = known.cell;
  line result;
  put(result, cell.cell.empty() ? "in no cell" : "cell " + cell.cell,
      look::strong);
  put(result, "  ");
  const auto link = link_text(shown.known.connection(), style.now_unix_ms);
  result.spans.insert(result.spans.end(), link.spans.begin(), link.spans.end());
  put(result, "  " + counted_text(cell.nodes.size(), "node") + "  "
                  + counted_text(cell.tasks.size(), "task") + "  "
                  + counted_text(known.instances.size(), "instance") + "  "
                  + known.asked.identity.name + " "
                  + known.asked.identity.address);
  return result;
}

/// What is wrong: the worst, and how much else.
line problem_line(const scene& shown, const frame_style& style) {
  line result;
  const auto& state = shown.known.connection();
  if (!state.problem.empty()) {
    put(result,
        (state.live ? "" : "what follows is as it was last; looking again: ")
            + state.problem,
        look::bad);
    return result;
  }
  const auto& known = shown.known.known();
  const auto problems = problems_of(known, style.now_unix_ms);
  if (!problems.empty()) {
    const auto others = problems.size() == 1
                            ? ""
                            : "(1 of " + std::to_string(problems.size()) + ") ";
    put(result, others + problems.front(), look::bad);
  } else if (shown.known.begun() && known.asked.role != node_role::coordinator)
    put(result,
        "this node only"
            + (known.asked.coordinator.empty()
                   ? ""
                   : "; the whole cell: --to " + known.asked.coordinator),
        look::faint);
  else if (shown.known.begun())
    put(result, "all is well", look::good);
  return result;
}

line event_footer(const scene& shown, const frame_style& style) {
  const auto& events = shown.known.known().events;
  line result;
  if (!events.empty())
    put(result, event_line(events.back(), style.width), look::faint);
  return result;
}

line key_line(const controls& now) {
  line result;
  if (now.typing) {
    put(result, "filter: ", look::strong);
    put(result, filter_of(now) + "_");
    put(result, "  Enter keeps it, Esc clears it", look::faint);
    return result;
  }
  if (!filter_of(now).empty())
    put(result, "filter: " + filter_of(now) + "  ", look::strong);
  if (!now.note.empty())
    put(result, now.note, look::busy);
  else if (now.where == top_page::overview)
    put(result, "Tab list  Enter details  l log  e events  s S sort  / filter  "
                "? help  q quit");
  else
    put(result, "Up Down PgUp PgDn move  / filter  e events  ? help  q back");
  return result;
}

void put_lists(frame& out, const scene& shown, const frame_style& style) {
  std::array<size_t, listed_kinds.size()> wanted{};
  for (size_t i = 0; i < out.lists.size(); ++i)
    wanted.at(i) = 1 + out.lists.at(i).rows.size();
  const auto room = style.height - std::min(style.height, lines_around);
  const auto heights = list_heights(wanted, shown.now.list, room);
  for (size_t i = 0; i < out.lists.size(); ++i) {
    const auto& choice = shown.now.lists.at(i);
    const auto& list = out.lists.at(i);
    for (auto& x : list_lines(
             list, {style.width, heights.at(i), style.utf8, i == shown.now.list,
                    selected_index(list, choice.selected), choice.order}))
      out.lines.push_back(std::move(x));
  }
  out.page = std::max<size_t>(2, heights.at(shown.now.list)) - 1;
}

void put_text(frame& out, const scene& shown, const frame_style& style) {
  const auto text = text_of(shown, style);
  line title;
  put(title, " " + text.title, look::heading);
  pad(title, style.width);
  title.spans.back().how = look::heading;
  out.lines.push_back(cut(title, style.width));
  out.page = std::max(style.height, lines_around + 2) - lines_around - 1;
  out.text_lines = text.lines.size();
  const auto last = out.text_lines - std::min(out.text_lines, out.page);
  const auto first = shown.now.at_end ? last : std::min(shown.now.scroll, last);
  for (size_t i = first; i < std::min(out.text_lines, first + out.page); ++i) {
    line x;
    put(x, text.lines[i]);
    out.lines.push_back(std::move(x));
  }
}

} // namespace

std::array<size_t, listed_kinds.size()>
list_heights(const std::array<size_t, listed_kinds.size()>& wanted,
             size_t focus, size_t room) {
  std::array<size_t, listed_kinds.size()> result{};
  const auto grow = [&](size_t i, size_t limit) {
    const auto target = std::min(wanted.at(i), limit);
    const auto more = std::min(room, target - std::min(target, result.at(i)));
    result.at(i) += more;
    room -= more;
  };
  grow(focus, 2);
  for (size_t i = 0; i < wanted.size(); ++i)
    grow(i, least_list);
  // Who moves in a list sees as much of it as there is room for.
  grow(focus, wanted.at(focus));
  for (size_t i = 0; i < wanted.size(); ++i)
    grow(i, wanted.at(i));
  return result;
}

frame make_frame(const scene& shown, const frame_style& style) {
  frame result;
  result.lists = all_lists(shown.known.known(), style.now_unix_ms);
  for (size_t i = 0; i < result.lists.size(); ++i)
    result.lists.at(i) = ordered(result.lists.at(i), shown.now.filter,
                                 shown.now.lists.at(i).order);
  result.lines = {first_line(shown, style), problem_line(shown, style)};
  if (shown.now.where == top_page::overview)
    put_lists(result, shown, style);
  else
    put_text(result, shown, style);
  const auto above_footer = style.height - std::min<size_t>(2, style.height);
  result.lines.resize(above_footer);
  result.lines.push_back(event_footer(shown, style));
  result.lines.push_back(key_line(shown.now));
  for (auto& x : result.lines)
    x = cut(std::move(x), style.width);
  result.lines.resize(style.height);
  return result;
}

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
