#include "actors/instances/process/process_runtime.hpp"

#include "actors/edge/limits.hpp"
#include "actors/edge/process/child_watch.hpp"
#include "actors/edge/process/instance_log.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

instance_log log_of(process_runtime_pointer self, const std::string& instance) {
  return instance_log{self->state.config.instances_dir / instance};
}

log_excerpt look(process_runtime_pointer self, const log_query& query) {
  const auto log = log_of(self, query.instance);
  const auto lines =
      query.tail_lines > 0 ? query.tail_lines : instance_log::default_lines;
  auto part = query.offset < 0 ? log.read_tail(lines, query.times)
                               : log.read_from(query.offset, query.times);
  return {query.instance, std::move(part.text),          part.next_offset,
          part.ended,     std::move(part.times_unix_ms), std::move(part.bytes)};
}

size_t follower_count(const process_runtime_state& st) {
  size_t result = 0;
  for (const auto& [instance, x] : st.logs)
    result += x.followers.size();
  return result;
}

followed_log& follow(process_runtime_pointer self,
                     const std::string& instance) {
  auto& st = self->state;
  const auto i = st.logs.find(instance);
  if (i != st.logs.end())
    return i->second;
  auto& result = st.logs[instance];
  const auto target = caf::actor_cast<process_runtime_actor>(self);
  result.watch = watch_folder(
      st.config.io, st.config.instances_dir / instance,
      [target, instance] { caf::anon_send(target, log_grown{instance}); });
  return result;
}

/// Answers those for whom `is_due` says so; the rest stays.
template <class Predicate>
void answer(process_runtime_pointer self, followed_log& log,
            Predicate&& is_due) {
  auto& xs = log.followers;
  for (auto i = xs.begin(); i != xs.end();) {
    auto excerpt = look(self, i->query);
    if (!is_due(*i, excerpt)) {
      ++i;
      continue;
    }
    i->promise.deliver(std::move(excerpt));
    i = xs.erase(i);
  }
}

} // namespace

caf::result<log_excerpt> read_log(process_runtime_pointer self,
                                  const log_query& query) {
  auto& st = self->state;
  if (!is_instance_id(query.instance) || !log_of(self, query.instance).exists())
    return no_log_of(query.instance);
  auto excerpt = look(self, query);
  const auto wait = wait_of(query);
  if (says_something(excerpt) || wait.count() == 0)
    return excerpt;
  if (follower_count(st) >= limits::log::followers)
    return too_many_followers();
  auto promise = self->make_response_promise<log_excerpt>();
  const auto until = self->clock().now() + wait;
  follow(self, query.instance).followers.push_back({query, until, promise});
  st.timer.set(self, until);
  // What was written before the watch began makes no noise.
  serve_followers(self, query.instance);
  return promise;
}

void serve_followers(process_runtime_pointer self,
                     const std::string& instance) {
  auto& logs = self->state.logs;
  const auto i = logs.find(instance);
  if (i == logs.end())
    return;
  answer(self, i->second, [](const log_follower&, const log_excerpt& excerpt) {
    return says_something(excerpt);
  });
  if (i->second.followers.empty())
    logs.erase(i);
}

void release_followers(process_runtime_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (auto i = st.logs.begin(); i != st.logs.end();) {
    answer(self, i->second,
           [now](const log_follower& x, const log_excerpt& excerpt) {
             return now >= x.until || says_something(excerpt);
           });
    for (const auto& x : i->second.followers)
      st.timer.set(self, x.until);
    i = i->second.followers.empty() ? st.logs.erase(i) : std::next(i);
  }
}

} // namespace roscell
