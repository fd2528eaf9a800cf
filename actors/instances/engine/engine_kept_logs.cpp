#include "actors/edge/engine/engine_log.hpp"
#include "actors/edge/history/kept_log_folder.hpp"
#include "actors/instances/engine/engine_containers.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/limits.hpp"
#include "schemas/base64.hpp"

#include <caf/send.hpp>

#include <chrono>
#include <limits>
#include <memory>
#include <utility>

namespace roscell {

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
