#include "actors/instances/exec/exec_steps.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/edge/exec/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace roscell {

namespace {

// Whoever waits is answered before those between him and us give up.
static_assert(limits::exec::wait < limits::local::answer);
// A client that waits as long as it may is not taken for gone.
static_assert(2 * limits::exec::wait < limits::exec::lease);

using input_waiter = exec_attachment::input_waiter;

caf::error unknown_command(const std::string& session) {
  return fail(error_code::unknown_task,
              "there is no command '" + session + "' here", "/session",
              "it has ended, or its node was started anew: run it again");
}

caf::error misplaced(const exec_session& x) {
  return fail(error_code::conflict,
              "what comes next of this input begins at "
                  + std::to_string(x.input_offset),
              "/offset");
}

void publish_end(exec_host_pointer self, const std::string& id,
                 const exec_session& x) {
  using namespace std::chrono;
  json data{
      {"session", id},
      {"exit_code", x.exit_code},
      {"took_ms",
       duration_cast<milliseconds>(self->clock().now() - x.began).count()}};
  if (!x.reason.empty())
    data["reason"] = x.reason;
  self->state.config.context.publish_event(events::exec_ended, x.instance,
                                           data);
}

void forget(exec_host_pointer self, const std::string& id) {
  self->state.table.remove(id);
  self->state.attached.erase(id);
}

/// Reads what was held back as long as there is room.
void read_on(exec_session& x, exec_attachment& to) {
  for (const bool of_errors : {false, true}) {
    auto& held = x.held[of_errors ? 1 : 0];
    if (!held || !x.output.has_room() || !to.channel)
      continue;
    held = false;
    to.channel->read_on(of_errors);
  }
}

exec_output output_of(const exec_session& x) {
  auto part = x.output.front();
  exec_output result;
  result.bytes = to_base64(part.bytes);
  result.of_errors = part.of_errors;
  result.next_offset = part.next_offset;
  result.ended = x.ended && part.is_last;
  if (result.ended) {
    result.exit_code = std::clamp(x.exit_code, 0, 255);
    result.reason = x.reason;
  }
  return result;
}

/// There is something to say, or nothing will come any more.
void serve_reader(exec_host_pointer self, const std::string& id) {
  auto& st = self->state;
  auto* x = st.table.find(id);
  auto& to = st.attached[id];
  if (!to.reader || (x->output.empty() && !x->ended))
    return;
  auto reader = *std::exchange(to.reader, std::nullopt);
  const auto answer = output_of(*x);
  reader.promise.deliver(answer);
  if (answer.ended)
    forget(self, id);
}

/// The size that a terminal has, and the end of whoever sits there.
void take_control(exec_session& x, exec_attachment& to,
                  const exec_input& request) {
  if (!to.channel || x.ended)
    return;
  if (request.columns > 0 && request.rows > 0)
    to.channel->resize(
        {static_cast<int>(request.columns), static_cast<int>(request.rows)});
  if (request.hang_up)
    to.channel->end("whoever has begun it has gone");
}

void give_to(exec_session& x, exec_attachment& to, std::string bytes,
             bool last) {
  x.input_offset += static_cast<int64_t>(bytes.size());
  x.input_ended = last;
  if (x.ended)
    return;
  x.input_pending = true;
  to.channel->write(std::move(bytes), last);
}

/// It has taken what it was given, so that the next may be.
void on_input_taken(exec_session& x, exec_attachment& to) {
  x.input_pending = false;
  if (std::exchange(x.end_pending, false))
    return give_to(x, to, {}, true);
  if (!to.writer)
    return;
  auto next = *std::exchange(to.writer, std::nullopt);
  if (next.offset == x.input_offset)
    give_to(x, to, std::move(next.bytes), next.ended);
  next.promise.deliver(exec_input_taken{x.input_offset});
}

void on_started(exec_attachment& to, const std::string& id) {
  if (auto starter = std::exchange(to.starter, std::nullopt))
    starter->deliver(exec_started{id});
}

void on_output(exec_session& x, exec_attachment& to,
               const exec_progress& event) {
  x.output.add(event.of_errors, event.bytes);
  x.held[event.of_errors ? 1 : 0] = true;
  read_on(x, to);
}

void on_ended(exec_host_pointer self, exec_session& x, exec_attachment& to,
              const exec_progress& event) {
  x.ended = true;
  x.exit_code = event.exit_code;
  if (x.reason.empty())
    x.reason = event.reason;
  to.channel.reset();
  publish_end(self, event.session, x);
  // Nothing reads any more what somebody waits to give.
  on_input_taken(x, to);
  const auto starter = std::exchange(to.starter, std::nullopt);
  if (!starter)
    return serve_reader(self, event.session);
  auto promise = *starter;
  promise.deliver(fail(error_code::engine_failed,
                       "the command cannot be run: " + x.reason));
  forget(self, event.session);
}

} // namespace

caf::result<exec_input_taken> take_input(exec_host_pointer self,
                                         const exec_input& request) {
  auto& st = self->state;
  const auto now = self->clock().now();
  auto* x = st.table.hear_of(request.session, now);
  if (x == nullptr)
    return unknown_command(request.session);
  auto bytes = from_base64(request.bytes);
  if (!bytes)
    return fail(error_code::schema_violation, "this is no base64", "/bytes");
  auto& to = st.attached[request.session];
  take_control(*x, to, request);
  if (bytes->empty() && !request.ended)
    return exec_input_taken{x->input_offset};
  switch (judge_input(*x, request.offset, bytes->size())) {
  case exec_verdict::known:
    break;
  case exec_verdict::misplaced:
    return misplaced(*x);
  case exec_verdict::take:
    give_to(*x, to, std::move(*bytes), request.ended);
    break;
  case exec_verdict::note_end:
    x->input_ended = x->end_pending = true;
    break;
  case exec_verdict::wait: {
    auto promise = self->make_response_promise<exec_input_taken>();
    if (to.writer)
      to.writer->promise.deliver(exec_input_taken{x->input_offset});
    input_waiter waits;
    waits.promise = promise;
    waits.until = now + limits::exec::wait;
    waits.offset = request.offset;
    waits.bytes = std::move(*bytes);
    waits.ended = request.ended;
    to.writer = std::move(waits);
    set_alarm(self);
    return promise;
  }
  }
  return exec_input_taken{x->input_offset};
}

caf::result<exec_output> give_output(exec_host_pointer self,
                                     const exec_output_query& query) {
  auto& st = self->state;
  const auto now = self->clock().now();
  auto* x = st.table.hear_of(query.session, now);
  if (x == nullptr)
    return unknown_command(query.session);
  if (!x->output.acknowledge(query.offset))
    return fail(error_code::conflict, "there is no output at this offset",
                "/offset");
  auto& to = st.attached[query.session];
  read_on(*x, to);
  auto promise = self->make_response_promise<exec_output>();
  if (to.reader)
    to.reader->promise.deliver(output_of(*x));
  const auto wait =
      std::clamp(std::chrono::milliseconds{query.wait_ms},
                 std::chrono::milliseconds{0}, limits::exec::wait);
  to.reader = {promise, now + wait};
  serve_reader(self, query.session);
  if (wait.count() == 0)
    on_alarm(self);
  else
    set_alarm(self);
  return promise;
}

void on_progress(exec_host_pointer self, const exec_progress& event) {
  auto& st = self->state;
  auto* x = st.table.find(event.session);
  if (x == nullptr || x->ended)
    return;
  auto& to = st.attached[event.session];
  if (event.ended)
    return on_ended(self, *x, to, event);
  if (event.input_taken)
    return on_input_taken(*x, to);
  if (event.bytes.empty())
    return on_started(to, event.session);
  on_output(*x, to, event);
  serve_reader(self, event.session);
}

namespace {

void release_waiters(exec_host_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (auto& [id, to] : st.attached) {
    const auto* x = st.table.find(id);
    if (to.reader && to.reader->until <= now)
      std::exchange(to.reader, std::nullopt)->promise.deliver(output_of(*x));
    if (to.writer && to.writer->until <= now)
      std::exchange(to.writer, std::nullopt)
          ->promise.deliver(exec_input_taken{x->input_offset});
  }
}

/// One that has ended and is not asked about is forgotten.
void end_lapsed(exec_host_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (const auto& id : st.table.lapsed(now)) {
    auto& x = *st.table.find(id);
    if (x.ended) {
      forget(self, id);
      continue;
    }
    x.reason = "nobody has asked for its output for "
               + std::to_string(limits::exec::lease.count()) + " s";
    // It is forgotten a lease later.
    x.heard = now;
    st.attached[id].channel->end(x.reason);
  }
}

} // namespace

void on_alarm(exec_host_pointer self) {
  release_waiters(self);
  end_lapsed(self);
  set_alarm(self);
}

void set_alarm(exec_host_pointer self) {
  auto& st = self->state;
  auto due = st.table.next_lapse();
  if (!due)
    return;
  for (const auto& [id, to] : st.attached) {
    if (to.reader)
      due = std::min(*due, to.reader->until);
    if (to.writer)
      due = std::min(*due, to.writer->until);
  }
  st.timer.set_anew(self, *due);
}

} // namespace roscell
