#include "tools/roscell/view/line.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace roscell::cli {

namespace {

constexpr std::string_view good_states[] = {
    "running",        "active", "member",   "deployed", "optimal", "joined",
    "already_member", "done",   "finished", "ok",       "✓"};

constexpr std::string_view bad_states[] = {
    "failed",  "lost",   "orphaned",         "degraded",           "returned",
    "unknown", "silent", "running, starved", "running, unhealthy", "broken",
    "✗"};

constexpr std::string_view busy_states[] = {
    "pending",     "building",    "starting",  "stopping",
    "joining",     "switching",   "deploying", "reserved",
    "terminating", "departing",   "expected",  "preparing",
    "unresolved",  "backing_off", "warning",   "!"};

template <class Words>
bool is_one_of(const std::string& word, const Words& words) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

} // namespace

void put(line& to, const std::string& text, look how) {
  if (!text.empty())
    to.spans.push_back({printable(text), how});
}

void pad(line& to, size_t column) {
  const auto width = width_of(to);
  if (width < column)
    put(to, std::string(column - width, ' '));
}

size_t width_of(const line& x) {
  size_t width = 0;
  for (const auto& part : x.spans)
    width += display_width(part.text);
  return width;
}

line cut(line x, size_t width) {
  size_t used = 0;
  for (auto& part : x.spans) {
    part.text = shortened(part.text, width - used);
    used += display_width(part.text);
  }
  return x;
}

std::string text_of(const line& x, bool colours) {
  std::string text;
  for (const auto& part : x.spans) {
    const auto colour =
        colours && !part.text.empty() ? colour_of(part.how) : "";
    text += colour + part.text + (colour.empty() ? "" : "\x1b[0m");
  }
  return text;
}

look look_of_state(const std::string& word) {
  return is_one_of(word, good_states)   ? look::good
         : is_one_of(word, bad_states)  ? look::bad
         : is_one_of(word, busy_states) ? look::busy
                                        : look::plain;
}

std::string colour_of(look how) {
  switch (how) {
  case look::strong:
  case look::heading:
    return "\x1b[1m";
  case look::good:
    return "\x1b[32m";
  case look::bad:
    return "\x1b[31m";
  case look::busy:
    return "\x1b[33m";
  default:
    return {};
  }
}

std::string state_colour(const std::string& word) {
  return colour_of(look_of_state(word));
}

} // namespace roscell::cli
