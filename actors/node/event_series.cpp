#include "actors/node/event_series.hpp"

#include "actors/node/limits.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace roscell {

namespace {

namespace limit = limits::event;

/// Series that are over are looked for when there are so many.
constexpr size_t many_series = 64;

/// What people ask for is told each time, whoever asks.
bool is_request(const std::string& what) {
  return what == events::request_received;
}

} // namespace

/// A span in which nothing has passed ends its series.
void event_series::forget_quiet(time_point now) {
  for (auto i = spans_.begin(); i != spans_.end();)
    i = i->second.end <= now && i->second.passed == 0 ? spans_.erase(i)
                                                      : std::next(i);
}

bool event_series::keeps(const event& x, time_point now) {
  if (is_request(x.what))
    return true;
  const auto kind = std::pair{x.what, x.subject};
  auto i = spans_.find(kind);
  if (i != spans_.end() && i->second.end <= now && i->second.passed == 0) {
    spans_.erase(i);
    i = spans_.end();
  }
  if (i == spans_.end()) {
    if (spans_.size() >= many_series)
      forget_quiet(now);
    if (spans_.size() >= limit::series)
      return true;
    i = spans_
            .emplace(kind, span{now + limit::repetition_window,
                                limit::repetition_window})
            .first;
  }
  auto& known = i->second;
  // A series that goes on is only counted.
  if (known.length == limit::repetition_window && known.passed == 0
      && known.kept < limit::repetitions) {
    ++known.kept;
    return true;
  }
  ++known.passed;
  known.last = x;
  return false;
}

std::vector<event_series::count> event_series::take_due(time_point now) {
  std::vector<count> result;
  forget_quiet(now);
  for (auto& [kind, x] : spans_) {
    if (x.end > now || x.passed == 0)
      continue;
    result.push_back({std::move(x.last), x.passed});
    const auto length = std::min<std::chrono::milliseconds>(
        2 * x.length, limit::longest_repetition_window);
    x = span{now + length, length};
  }
  return result;
}

std::vector<event_series::count> event_series::take_all() {
  std::vector<count> result;
  for (auto& [kind, x] : spans_)
    if (x.passed > 0)
      result.push_back({std::move(x.last), x.passed});
  spans_.clear();
  return result;
}

std::vector<event> event_series::last_ones() const {
  std::vector<event> result;
  for (const auto& [kind, x] : spans_)
    if (x.passed > 0)
      result.push_back(x.last);
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::pair{a.sequence, a.time_unix_ms}
           < std::pair{b.sequence, b.time_unix_ms};
  });
  return result;
}

std::optional<event_series::time_point> event_series::next() const {
  std::optional<time_point> result;
  for (const auto& [kind, x] : spans_)
    if (x.passed > 0 && (!result || x.end < *result))
      result = x.end;
  return result;
}

namespace {

/// Whether unauthenticated peers can provoke it without end.
bool is_refusal(std::string_view what) {
  constexpr std::string_view ignored = "_ignored";
  return what == events::session_refused || what == events::request_refused
         || (what.size() > ignored.size()
             && what.substr(what.size() - ignored.size()) == ignored);
}

} // namespace

bool refusal_gate::lets_through(const std::string& what,
                                const std::string& subject, time_point now) {
  if (!is_refusal(what))
    return true;
  // The subject of others is whoever was refused, of whom there are many.
  const auto kind = std::pair{
      what, what == events::request_refused ? subject : std::string{}};
  auto i = spans_.find(kind);
  if (i == spans_.end() || (i->second.end <= now && i->second.held == 0))
    i = spans_.insert_or_assign(kind, span{now + limits::event::refusal_window})
            .first;
  if (i->second.reported < limits::event::refusals) {
    ++i->second.reported;
    return true;
  }
  ++i->second.held;
  return false;
}

std::vector<refusal_gate::summary> refusal_gate::take_due(time_point now) {
  std::vector<summary> result;
  for (auto i = spans_.begin(); i != spans_.end();) {
    if (i->second.end > now) {
      ++i;
      continue;
    }
    if (i->second.held > 0)
      result.push_back({i->first.first, i->first.second, i->second.held});
    i = spans_.erase(i);
  }
  return result;
}

std::optional<refusal_gate::time_point> refusal_gate::next() const {
  std::optional<time_point> result;
  for (const auto& [kind, x] : spans_)
    if (x.held > 0 && (!result || x.end < *result))
      result = x.end;
  return result;
}

namespace {

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size()
         && text.substr(text.size() - end.size()) == end;
}

bool is_failure_event(const event& e) {
  const auto data = json::parse(e.data, nullptr, false);
  return data.is_object() && data.value("state", json{}) == "failed";
}

} // namespace

loudness loudness_of(const event& e) {
  for (const auto* end : {"_lost", "_failed", "_refused", "_ignored"})
    if (ends_with(e.what, end))
      return loudness::warning;
  if (e.what != events::instance_changed)
    return loudness::info;
  return is_failure_event(e) ? loudness::warning : loudness::debug;
}

} // namespace roscell
