#include "embedding/skills/actor_runtime.hpp"

#include "actors/edge/limits.hpp"

#include <utility>

namespace roscell::embedding {

namespace {

constexpr int64_t default_lines = 100;

log_excerpt look(const kept_skill& x, const log_query& query) {
  const auto lines = query.tail_lines > 0 ? query.tail_lines : default_lines;
  auto part = query.offset < 0
                  ? x.log->read_tail(static_cast<std::size_t>(lines))
                  : x.log->read_from(query.offset);
  return {query.instance,
          std::move(part.text),
          part.next_offset,
          !x.keeper && part.is_whole,
          query.times ? std::move(part.times_unix_ms) : std::vector<int64_t>{},
          {}};
}

std::size_t follower_count(const actor_runtime_state& st) {
  std::size_t result = 0;
  for (const auto& [instance, x] : st.skills)
    result += x.followers.size();
  return result;
}

} // namespace

caf::result<log_excerpt> read_log(actor_runtime_pointer self,
                                  const log_query& query) {
  auto& st = self->state;
  const auto i = st.skills.find(query.instance);
  if (i == st.skills.end())
    return no_log_of(query.instance);
  auto excerpt = look(i->second, query);
  const auto wait = wait_of(query);
  if (says_something(excerpt) || wait.count() == 0)
    return excerpt;
  if (follower_count(st) >= limits::log::followers)
    return too_many_followers();
  auto promise = self->make_response_promise<log_excerpt>();
  const auto until = self->clock().now() + wait;
  i->second.followers.push_back({query, until, promise});
  st.timer.set(self, until);
  return promise;
}

void serve_followers(actor_runtime_pointer self, kept_skill& x) {
  const auto now = self->clock().now();
  auto waiting = std::exchange(x.followers, {});
  for (auto& each : waiting) {
    auto excerpt = look(x, each.query);
    if (says_something(excerpt) || now >= each.until) {
      each.promise.deliver(std::move(excerpt));
      continue;
    }
    self->state.timer.set(self, each.until);
    x.followers.push_back(std::move(each));
  }
}

void release_followers(kept_skill& x) {
  for (auto& each : std::exchange(x.followers, {})) {
    auto excerpt = look(x, each.query);
    excerpt.ended = true;
    each.promise.deliver(std::move(excerpt));
  }
}

} // namespace roscell::embedding
