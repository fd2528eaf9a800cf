#include "actors/instances/exec/exec_table.hpp"

#include "actors/edge/exec/limits.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>

namespace roscell {

exec_session* exec_table::begin(const std::string& id,
                                const std::string& instance, bool terminal,
                                time_point now) {
  if (sessions_.size() >= limits::exec::most)
    return nullptr;
  auto& result = sessions_[id];
  result.instance = instance;
  result.terminal = terminal;
  result.began = result.heard = now;
  return &result;
}

exec_session* exec_table::find(const std::string& id) {
  const auto i = sessions_.find(id);
  return i == sessions_.end() ? nullptr : &i->second;
}

exec_session* exec_table::hear_of(const std::string& id, time_point now) {
  auto* result = find(id);
  if (result != nullptr)
    result->heard = now;
  return result;
}

void exec_table::remove(const std::string& id) {
  sessions_.erase(id);
}

std::vector<std::string> exec_table::lapsed(time_point now) const {
  std::vector<std::string> result;
  for (const auto& [id, x] : sessions_)
    if (now - x.heard >= limits::exec::lease)
      result.push_back(id);
  return result;
}

std::optional<exec_table::time_point> exec_table::next_lapse() const {
  std::optional<time_point> result;
  for (const auto& [id, x] : sessions_) {
    const auto due = x.heard + limits::exec::lease;
    result = result ? std::min(*result, due) : due;
  }
  return result;
}

exec_verdict judge_input(const exec_session& x, int64_t offset, size_t bytes) {
  const auto end = offset + static_cast<int64_t>(bytes);
  const bool again = offset < x.input_offset || (x.input_ended && bytes == 0);
  if (again && end <= x.input_offset)
    return exec_verdict::known;
  if (offset != x.input_offset || x.input_ended)
    return exec_verdict::misplaced;
  if (!x.input_pending)
    return exec_verdict::take;
  return bytes == 0 ? exec_verdict::note_end : exec_verdict::wait;
}

std::string first_word(const std::vector<std::string>& command) {
  constexpr size_t most = 64;
  if (command.empty())
    return {};
  const auto& path = command.front();
  const auto slash = path.find_last_of('/');
  return valid_utf8(
      path.substr(slash == std::string::npos ? 0 : slash + 1).substr(0, most));
}

} // namespace roscell
