#pragma once

#include "actors/core/watching.hpp"
#include "actors/session/lease.hpp"
#include "actors/session/session_exchange.hpp"
#include "messages/actors.hpp"

#include <caf/actor_cast.hpp>
#include <caf/result.hpp>
#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>

/// What the owners of sessions have in common: the member, the peer and the
/// membership.
namespace roscell {

/// A session as its owner holds it, whose state derives from this.
struct held_session {
  session_actor session; ///< Invalid while there is none.
  lease life;
  session_exchange frames;

  /// When something is due although the other side says nothing.
  std::chrono::steady_clock::time_point next() const {
    const auto answers = frames.calls().next_deadline();
    return session ? std::min(answers, life.next()) : answers;
  }
};

/// Takes a session over, which has just been opened.
template <class Self>
void hold_session(Self self, session_actor session, lease_side side) {
  auto& st = self->state;
  st.session = std::move(session);
  st.life = lease{side, self->clock().now()};
  st.frames = session_exchange{[self](std::string text) {
    self->send(self->state.session, send_frame{std::move(text)});
  }};
  watch_until_its_end(self, st.session);
  self->send(st.session,
             own_session{caf::actor_cast<session_owner_actor>(self)});
}

/// Whether the message that is being handled comes from the session: one that
/// was given up may still say something.
template <class Self>
bool is_from_session(Self self) {
  const auto& sender = self->current_sender();
  const auto& session = self->state.session;
  return sender && session && sender->id() == session.id();
}

/// Takes a frame. Gives what the owner has to do for it.
template <class Self>
std::optional<session_inquiry> hear_frame(Self self,
                                          const frame_received& frame) {
  auto& st = self->state;
  st.life.heard(self->clock().now());
  return st.frames.receive(frame.text);
}

template <class Self>
void hear_heartbeat(Self self, const heartbeat_received& heartbeat) {
  auto& st = self->state;
  if (auto answer =
          st.life.heard_heartbeat(heartbeat.kind, self->clock().now()))
    self->send(st.session, send_heartbeat{*answer, heartbeat.sequence});
}

/// Does what is due for the lease. False if the other side is lost by it.
template <class Self>
bool keep_lease(Self self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  if (!st.session || now < st.life.next())
    return true;
  const auto next = st.life.due(now);
  if (next.send)
    self->send(st.session, send_heartbeat{*next.send, 0});
  return !next.over;
}

/// A check of what the other side has answered, or a correction of it.
template <class Reply>
using reply_review = std::function<void(Reply&)>;

/// Asks the other side. The owner sets its timer anew.
template <class Reply, class Self, class Request>
caf::result<Reply> ask_other_side(Self self, const Request& what,
                                  std::chrono::milliseconds timeout,
                                  const reply_review<Reply>& look = nullptr) {
  auto promise = self->template make_response_promise<Reply>();
  auto on_result = [promise, look](const caf::expected<json>& body) mutable {
    auto reply = body ? reply_as<Reply>(*body) : body.error();
    if (reply && look)
      look(*reply);
    if (reply)
      promise.deliver(std::move(*reply));
    else
      promise.deliver(std::move(reply.error()));
  };
  self->state.frames.call(message_json(what), self->clock().now() + timeout,
                          std::move(on_result));
  return promise;
}

} // namespace roscell
