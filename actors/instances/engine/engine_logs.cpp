#include "actors/edge/engine/engine_log.hpp"
#include "actors/edge/history/kept_log_folder.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/limits.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"

#include <caf/send.hpp>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <utility>

namespace roscell {

namespace {

/// Asks for whole seconds: Podman reads fractions inexactly. The collector
/// leaves out what is too early.
std::string log_target(const std::string& container, const log_query& query,
                       log_ticks origin, bool follow) {
  auto result = "/containers/" + percent_encode(container)
                + "/logs?stdout=true&stderr=true&timestamps=true";
  if (query.offset < 0) {
    const auto lines =
        query.tail_lines > 0 ? query.tail_lines : instance_log::default_lines;
    result += "&tail=" + std::to_string(lines);
  } else if (query.offset > 0) {
    const auto since_ms = (origin + query.offset) / log_ticks_per_ms;
    result += "&since=" + std::to_string(since_ms / 1000);
  }
  return follow ? result + "&follow=true" : result;
}

/// The follower leaves with its answer.
void deliver(engine_runtime_pointer self, uint64_t call, log_excerpt excerpt) {
  auto& st = self->state;
  const auto i = st.followers.find(call);
  if (i == st.followers.end())
    return;
  auto promise = i->second.promise;
  excerpt.instance = i->second.query.instance;
  st.followers.erase(i);
  st.calls.erase(call);
  promise.deliver(std::move(excerpt));
}

/// The stream has ended, and nothing that was asked for was in it.
void on_log_ended(engine_runtime_pointer self, uint64_t call,
                  const engine_answered& x) {
  auto& st = self->state;
  const auto i = st.followers.find(call);
  if (i == st.followers.end())
    return;
  if (is_good(x)) {
    const auto offset = std::max<int64_t>(0, i->second.query.offset);
    const bool ended = !i->second.running || i->second.until;
    return deliver(self, call, {{}, {}, offset, ended});
  }
  auto promise = i->second.promise;
  const auto instance = i->second.query.instance;
  st.followers.erase(i);
  promise.deliver(x.status == 404 ? no_log_of(instance)
                                  : engine_failure("no log can be read", x));
}

/// What the io thread collects.
struct log_reading {
  log_collector collector;
  bool is_whole = true; ///< Nothing is behind what was collected.
};

/// Collects on the io thread, and tells of the first part that has text.
engine_stream_callbacks collect(engine_runtime_pointer self, uint64_t call,
                                log_range range, bool follow) {
  const auto target = caf::actor_cast<engine_runtime_actor>(self);
  const auto reading =
      std::make_shared<log_reading>(log_reading{log_collector{range}});
  engine_stream_callbacks calls;
  calls.on_bytes = [reading, follow](std::string_view bytes) {
    auto& [collector, is_whole] = *reading;
    is_whole = collector.take(bytes);
    return is_whole && !(follow && !collector.empty());
  };
  calls.on_end = [target, call, reading](engine_answer answer) {
    auto& [collector, is_whole] = *reading;
    auto end = to_message(call, std::move(answer));
    if (collector.empty())
      return caf::anon_send(target, std::move(end));
    auto part = collector.part();
    caf::anon_send(target,
                   engine_log_read{call, std::move(part.text), part.next_offset,
                                   is_whole && is_good(end),
                                   std::move(part.times_unix_ms),
                                   std::move(part.bytes)});
  };
  return calls;
}

void open_log(engine_runtime_pointer self, const engine_answered& x,
              engine_log_follower follower) {
  auto& st = self->state;
  const auto found = object_of(x);
  const auto created = parse_log_time(text_at(found, "Created"));
  const auto query = follower.query;
  if (!is_good(x) || !created) {
    follower.promise.deliver(x.status == 404
                                 ? no_log_of(query.instance)
                                 : engine_failure("no log can be read", x));
    return;
  }
  follower.running = is_running(found);
  const auto wait = wait_of(query);
  const bool follow = follower.running && wait.count() > 0;
  // Who follows asks again at once: an answer without text would go round.
  if (follow && st.followers.size() >= limits::log::followers) {
    follower.promise.deliver(too_many_followers());
    return;
  }
  const auto origin = *created;
  if (follow) {
    follower.until = self->clock().now() + wait;
    st.timer.set(self, *follower.until);
  }
  const auto number = std::make_shared<uint64_t>(0);
  const auto call =
      expect_answer(self, [self, number](const engine_answered& y) {
        on_log_ended(self, *number, y);
      });
  *number = call;
  engine_request request;
  request.target = log_target(text_at(found, "Id"), query, origin, follow);
  request.endless = follow;
  const log_range range{origin, std::max<int64_t>(0, query.offset),
                        query.offset < 0, query.times};
  follower.stream =
      st.client->stream(std::move(request), collect(self, call, range, follow));
  st.followers.emplace(call, std::move(follower));
}

} // namespace

caf::result<log_excerpt> read_log(engine_runtime_pointer self,
                                  const log_query& query) {
  if (!is_instance_id(query.instance))
    return no_log_of(query.instance);
  auto follower = std::make_shared<engine_log_follower>();
  follower->query = query;
  const auto promise = follower->promise =
      self->make_response_promise<log_excerpt>();
  engine_request request;
  request.target =
      "/containers/" + percent_encode(container_name(query.instance)) + "/json";
  ask_engine(self, std::move(request), [=](const engine_answered& x) {
    open_log(self, x, std::move(*follower));
  });
  return promise;
}

void on_log_read(engine_runtime_pointer self, const engine_log_read& part) {
  if (take_end_of_log(self, part))
    return;
  const auto i = self->state.followers.find(part.call);
  if (i == self->state.followers.end())
    return;
  const bool ended = !i->second.running && part.is_whole;
  deliver(
      self, part.call,
      {{}, part.text, part.next_offset, ended, part.times_unix_ms, part.bytes});
}

void release_followers(engine_runtime_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  std::vector<uint64_t> due;
  for (const auto& [call, x] : st.followers) {
    if (x.until && now >= *x.until)
      due.push_back(call);
    else if (x.until)
      st.timer.set(self, *x.until);
  }
  for (const auto call : due) {
    const auto offset =
        std::max<int64_t>(0, st.followers.at(call).query.offset);
    deliver(self, call, {{}, {}, offset, false});
  }
}

namespace {

/// The container is removed all the same when its log does not come in time.
constexpr std::chrono::seconds log_limit{4};

static_assert(log_limit + limits::instance::force < limits::instance::cleaning);

/// Most lines that are asked for; bytes bound it further.
constexpr const char* all_of_it =
    "/logs?stdout=true&stderr=true&timestamps=true&tail=100000";

/// Collects on the io thread, and tells what it was at the end.
engine_stream_callbacks collect_end(engine_runtime_pointer self,
                                    uint64_t call) {
  const auto target = caf::actor_cast<engine_runtime_actor>(self);
  log_range range;
  range.last_part = range.times = true;
  range.most_bytes = self->state.config.setting.log_bytes;
  range.most_lines = std::numeric_limits<int64_t>::max();
  const auto collector = std::make_shared<log_collector>(range);
  engine_stream_callbacks calls;
  calls.on_bytes = [collector](std::string_view bytes) {
    return collector->take(bytes);
  };
  calls.on_end = [target, call, collector](engine_answer answer) {
    const auto end = to_message(call, std::move(answer));
    if (!is_good(end))
      return caf::anon_send(target, end);
    auto part = collector->part();
    caf::anon_send(target,
                   engine_log_read{call, std::move(part.text), part.next_offset,
                                   true, std::move(part.times_unix_ms),
                                   std::move(part.bytes)});
  };
  return calls;
}

/// What waits for it goes on; null where it does not wait any more.
std::function<void()> finish_reading(engine_runtime_pointer self,
                                     uint64_t call) {
  auto& readings = self->state.readings;
  const auto i = readings.find(call);
  if (i == readings.end())
    return nullptr;
  auto then = std::move(i->second.then);
  readings.erase(i);
  self->state.calls.erase(call);
  return then;
}

} // namespace

void keep_log(engine_runtime_pointer self, const remove_container& request,
              std::function<void()> then) {
  auto& st = self->state;
  if (request.about.empty() || st.config.kept_logs.empty())
    return then();
  const auto number = std::make_shared<uint64_t>(0);
  const auto call = expect_answer(self, [self, number](const engine_answered&) {
    if (const auto next = finish_reading(self, *number))
      next();
  });
  *number = call;
  const auto target = target_of(request.container, request.instance);
  auto& reading = st.readings[call];
  reading.about = request.about.front();
  reading.then = std::move(then);
  reading.stream =
      st.client->stream(to_container("GET", target, all_of_it, log_limit),
                        collect_end(self, call));
}

bool take_end_of_log(engine_runtime_pointer self, const engine_log_read& end) {
  auto& st = self->state;
  const auto i = st.readings.find(end.call);
  if (i == st.readings.end())
    return false;
  log_part part;
  part.text = from_base64(end.bytes).value_or("");
  if (part.text.empty())
    part.text = end.text;
  part.times_unix_ms = end.times_unix_ms;
  kept_log_folder history{st.config.kept_logs};
  if (history.keep(part, i->second.about) && st.config.history)
    caf::anon_send(st.config.history, log_kept{});
  finish_reading(self, end.call)();
  return true;
}

} // namespace roscell
