#include "actors/node/refusal_gate.hpp"

#include "actors/node/limits.hpp"
#include "messages/event_kinds.hpp"

#include <string_view>

namespace roscell {

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

} // namespace roscell
