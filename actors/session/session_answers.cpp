#include "actors/session/session_answers.hpp"

#include "actors/session/limits.hpp"

#include <algorithm>

namespace roscell {

session_answers::admission session_answers::admit(uint64_t id) {
  if (auto known = answers_.find(id); known != answers_.end()) {
    const auto& x = known->second;
    if (!x.done)
      return {verdict::busy, {}};
    if (x.text.empty())
      return {verdict::stale, {}};
    return {verdict::repeat, x.text};
  }
  if (id <= forgotten_)
    return {verdict::stale, {}};
  if (answers_.size() >= limits::session::known_calls && !drop_oldest_done())
    return {verdict::crowded, {}};
  answers_.emplace(id, answer{});
  return {verdict::fresh, {}};
}

void session_answers::record(uint64_t id, const std::string& text) {
  auto known = answers_.find(id);
  if (known == answers_.end())
    return;
  known->second.done = true;
  if (text.size() <= limits::session::kept_answer_bytes)
    known->second.text = text;
}

bool session_answers::drop_oldest_done() {
  auto oldest = std::find_if(answers_.begin(), answers_.end(),
                             [](const auto& x) { return x.second.done; });
  if (oldest == answers_.end())
    return false;
  forgotten_ = std::max(forgotten_, oldest->first);
  answers_.erase(oldest);
  return true;
}

} // namespace roscell
