#include "actors/requests/rest_streams.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/shifted_times.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/io/node_time.hpp"
#include "schemas/document.hpp"
#include "schemas/utf8.hpp"

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

namespace roscell {

namespace {

constexpr const char* text_content = "text/plain; charset=utf-8";

std::string server_sent(const event& x) {
  const auto data =
      message_json(x).dump(-1, ' ', false, json::error_handler_t::replace);
  return "id: " + std::to_string(x.sequence) + "\nevent: " + x.what
         + "\ndata: " + data + "\n\n";
}

/// What is in memory has its times by the node's own clock, what is on the disk
/// by the wall clock.
event with_wall_time(event x) {
  x.time_unix_ms = to_wall_clock()(x.time_unix_ms);
  return x;
}

struct event_stream_state {
  static constexpr const char* name = "event-stream";

  uint64_t written = 0;
};

event_stream_actor::behavior_type
event_stream(event_stream_actor::stateful_pointer<event_stream_state> self,
             const std::shared_ptr<http_stream>& stream) {
  return {
      [self](const state_query&) {
        return state_of({{"written", self->state.written}});
      },
      [self, stream](const event& x) {
        ++self->state.written;
        if (!stream->write(server_sent(with_wall_time(x))))
          self->quit();
      },
  };
}

struct event_reader_state {
  static constexpr const char* name = "event-reader";
};

/// Asks for the events once and ends.
introspected_actor::behavior_type
event_reader(introspected_actor::stateful_pointer<event_reader_state> self,
             const event_log_actor& events, const responder& answer,
             const event_question& which) {
  const bool in_memory = std::holds_alternative<kept_events_query>(which);
  const auto on_kept = [=](const kept_events& kept) {
    std::string text;
    for (const auto& x : kept.events)
      text += server_sent(in_memory ? with_wall_time(x) : x);
    answer.reply(200, event_stream_content, text);
    self->quit();
  };
  const auto on_error = [self, answer](const caf::error& error) {
    const auto why = to_failure(error);
    answer.error(http_status(why.code), why.code, why.message, why.hint);
    self->quit();
  };
  std::visit(
      [&](const auto& query) {
        self->request(events, limits::local::answer, query)
            .then(on_kept, on_error);
      },
      which);
  return {[](const state_query&) { return state_of(json::object()); }};
}

using log_pointer = introspected_actor::stateful_pointer<log_stream_state>;

void ask_for_more(log_pointer self);

void finish_log_stream(log_pointer self) {
  if (self->state.stream)
    self->state.stream->close();
  self->quit();
}

void on_excerpt(log_pointer self, const log_excerpt& excerpt) {
  auto& st = self->state;
  const bool more = st.request.follow && !excerpt.ended;
  const auto text = st.timed.add(excerpt);
  if (!st.stream && !more) {
    st.answer->reply(200, text_content, text);
    return finish_log_stream(self);
  }
  if (!st.stream) {
    st.stream = st.answer->stream(text_content);
    st.stream->on_closed([me = introspected_actor{self}] {
      caf::anon_send_exit(me, caf::exit_reason::user_shutdown);
    });
  }
  if (!text.empty() && !st.stream->write(text))
    return finish_log_stream(self);
  if (!more)
    return finish_log_stream(self);
  st.request.query.offset = excerpt.next_offset;
  st.request.query.wait_ms = limits::log::wait.count();
  ask_for_more(self);
}

void on_reply(log_pointer self, const request_routed& reply) {
  auto& st = self->state;
  if (!reply.refusal.empty()) {
    // Once bytes have been sent, the end of the stream is all that can be told.
    if (!st.stream)
      st.answer->reply(http_status(error_code_from(reply.refusal)),
                       json_content, reply.text);
    return finish_log_stream(self);
  }
  auto excerpt = decode<log_excerpt>(json::parse(reply.text));
  if (auto* x = std::get_if<log_excerpt>(&excerpt))
    on_excerpt(self, *x);
  else
    finish_log_stream(self);
}

void ask_for_more(log_pointer self) {
  auto& st = self->state;
  self->request(st.router, limits::log::stream,
                route_request{message_json(st.request.query).dump()})
      .then([self](const request_routed& reply) { on_reply(self, reply); },
            [self](const caf::error&) { finish_log_stream(self); });
}

} // namespace

void start_event_stream(caf::actor_system& system, const actor_context& context,
                        const std::shared_ptr<http_stream>& stream,
                        uint64_t since) {
  // A first comment makes the client see at once that it is connected.
  stream->write(": events of this node\n\n");
  auto listener = spawn(system, context, event_stream, stream);
  caf::anon_send(context.events, subscribe_events{listener, since});
  stream->on_closed([listener] {
    caf::anon_send_exit(listener, caf::exit_reason::user_shutdown);
  });
}

void send_kept_events(caf::actor_system& system, const actor_context& context,
                      const responder& answer, const event_question& which) {
  spawn(system, context, event_reader, context.events, answer, which);
}

introspected_actor::behavior_type log_stream(log_pointer self,
                                             const request_router_actor& router,
                                             const log_stream_request& request,
                                             const responder& answer) {
  self->state.router = router;
  self->state.request = request;
  self->state.answer = answer;
  watch_until_own_end(self, router);
  self->set_down_handler(
      [self](const caf::down_msg&) { finish_log_stream(self); });
  ask_for_more(self);
  return {
      [self](const state_query&) {
        return state_of({{"instance", self->state.request.query.instance},
                         {"offset", self->state.request.query.offset}});
      },
  };
}

std::string timed_log::add(const log_excerpt& part) {
  const auto text = from_base64(part.bytes).value_or("");
  const auto& said = part.bytes.empty() ? part.text : text;
  if (part.times_unix_ms.empty())
    return said;
  std::string result;
  size_t line = 0;
  for (size_t at = 0; at < said.size(); ++line) {
    const auto newline = said.find('\n', at);
    const bool open = newline == std::string::npos;
    const auto end = open ? said.size() : newline + 1;
    const auto time =
        line < part.times_unix_ms.size() ? part.times_unix_ms[line] : 0;
    if (!in_line_)
      result += (time == 0 ? "-" : iso_time(time)) + " ";
    result += said.substr(at, end - at);
    in_line_ = open;
    at = end;
  }
  return result;
}

} // namespace roscell
