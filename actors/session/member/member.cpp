#include "actors/session/member/member.hpp"

#include "actors/builds/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/watching.hpp"
#include "actors/session/limits.hpp"
#include "schemas/document.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace member_steps {

namespace {

/// Since the node's last word.
std::chrono::milliseconds missed_heartbeats_of(self_pointer self) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      self->clock().now() - self->state.life.last_heard());
}

} // namespace

void set_timer(self_pointer self) {
  auto& st = self->state;
  if (st.ended)
    return;
  auto when = st.next();
  if (st.phase == member_phase::awaiting)
    when = std::min(when, st.registration_deadline);
  st.timer.set(self, when);
}

void end_member(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  if (std::exchange(st.ended, true))
    return;
  st.frames.calls().fail_all("node '" + st.peer.name
                             + "' is out of reach: " + reason);
  if (st.announced && st.phase != member_phase::departed)
    self->send(st.coordinator,
               member_lost{st.peer.uuid, caf::actor_cast<member_actor>(self),
                           reason, missed_heartbeats_of(self).count()});
  self->send(st.session, close_session{reason});
  self->quit();
}

} // namespace member_steps

namespace {

using namespace member_steps;

using phase = member_phase;

auto now(self_pointer self) {
  return self->clock().now();
}

// -- what the session brings -------------------------------------------------

void on_frame(self_pointer self, const frame_received& frame) {
  auto& st = self->state;
  if (st.ended || !is_from_session(self))
    return;
  if (auto x = hear_frame(self, frame)) {
    if (x->id)
      on_request(self, *x->id, *x);
    else
      on_notice(self, x->body);
  }
  if (st.frames.hopeless())
    end_member(self, "it sent frames that make no sense");
  set_timer(self);
}

void on_heartbeat(self_pointer self, const heartbeat_received& heartbeat) {
  if (!self->state.ended && is_from_session(self))
    hear_heartbeat(self, heartbeat);
}

void on_tick(self_pointer self, uint64_t number) {
  auto& st = self->state;
  if (st.ended || !st.timer.rings(number))
    return;
  const auto time = now(self);
  if (st.phase == phase::awaiting && time >= st.registration_deadline)
    return end_member(self, "it did not register in time");
  st.frames.calls().expire(time);
  if (!keep_lease(self))
    return end_member(self, missed_heartbeats_text());
  set_timer(self);
}

// -- what the coordinator asks -----------------------------------------------

caf::error not_a_member(self_pointer self) {
  return fail(error_code::unreachable,
              "node '" + self->state.peer.name + "' is not a member now");
}

template <class Reply, class Request>
caf::result<Reply> ask_node(self_pointer self, const Request& what,
                            std::chrono::milliseconds timeout,
                            const reply_review<Reply>& look = nullptr) {
  if (self->state.phase != phase::active)
    return not_a_member(self);
  auto reply = ask_other_side<Reply>(self, what, timeout, look);
  set_timer(self);
  return reply;
}

/// Another node's user asks what only this node can answer.
caf::result<request_routed> relay(self_pointer self,
                                  const route_request& request) {
  auto& st = self->state;
  auto parsed = parse_document(request.text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return to_error(*why);
  const auto& body = std::get<json>(parsed);
  const auto limit = relayed_limit(body.value("type", ""));
  if (!limit)
    return fail(error_code::unknown_type,
                "no node answers this for another one", "/type");
  if (st.phase != phase::active)
    return not_a_member(self);
  auto promise = self->make_response_promise<request_routed>();
  st.frames.call(body, now(self) + *limit + relay_margin,
                 [promise](caf::expected<json> reply) mutable {
                   if (reply)
                     promise.deliver(request_routed{reply->dump(), ""});
                   else
                     promise.deliver(std::move(reply.error()));
                 });
  set_timer(self);
  return promise;
}

actor_state describe(self_pointer self) {
  const auto& st = self->state;
  const auto silence = now(self) - st.life.last_heard();
  return state_of(
      {{"node", st.peer.name},
       {"uuid", st.peer.uuid},
       {"epoch", st.peer.epoch},
       {"phase", st.phase},
       {"pending_calls", st.frames.calls().pending()},
       {"silent_ms",
        std::chrono::duration_cast<std::chrono::milliseconds>(silence)
            .count()}});
}

void take_over(self_pointer self, session_admitted accepted,
               cell_coordinator_actor coordinator) {
  auto& st = self->state;
  st.peer = std::move(accepted.peer);
  st.coordinator = std::move(coordinator);
  st.registration_deadline =
      now(self) + limits::membership::registration_arrival;
  hold_session(self, std::move(accepted.session), lease_side::coordinator);
  watch_until_own_end(self, st.coordinator);
  self->set_down_handler([self](const caf::down_msg& down) {
    end_member(self, down.source == self->state.session
                         ? "its session has failed"
                         : "the coordinator has stopped");
  });
  set_timer(self);
}

caf::result<resource_report> report_resources(self_pointer self,
                                              const resource_query& x) {
  return ask_node<resource_report>(self, x, limits::session::resource_query,
                                   [self](resource_report& report) {
                                     report.resources.name =
                                         self->state.peer.name;
                                   });
}

caf::result<instance_deployed> deploy(self_pointer self,
                                      const instance_deployment& x) {
  return ask_node<instance_deployed>(
      self, x, limits::task::deployment, [self](instance_deployed& reply) {
        reply.instance.node = self->state.peer.name;
      });
}

caf::result<kept_logs> list_kept_logs(self_pointer self,
                                      const kept_logs_query& x) {
  return ask_node<kept_logs>(self, x, limits::history::member_list,
                             [self](kept_logs& reply) {
                               for (auto& log : reply.logs)
                                 log.node = self->state.peer.name;
                             });
}

} // namespace

member_actor::behavior_type member(self_pointer self, session_admitted accepted,
                                   cell_coordinator_actor coordinator) {
  take_over(self, std::move(accepted), std::move(coordinator));
  return {
      [self](const state_query&) { return describe(self); },
      [self](const resource_query& x) { return report_resources(self, x); },
      [self](const figures_query& x) {
        return ask_node<figures_report>(self, x, limits::session::metrics);
      },
      [self](const instance_reservation& x) {
        return ask_node<instances_reserved>(self, x,
                                            limits::session::resource_query);
      },
      [self](const instance_deployment& x) { return deploy(self, x); },
      [self](const instance_removal& x) {
        return ask_node<instances_removed>(self, x, limits::task::removal);
      },
      [self](const set_parameters& x) {
        return ask_node<parameters_set>(self, x, limits::session::parameters);
      },
      [self](const build_keeping& x) {
        return ask_node<build_kept>(self, x, limits::build::keeping_session);
      },
      [self](const build_release& x) {
        return ask_node<build_released>(self, x, limits::build::disk);
      },
      [self](const image_query& x) {
        return ask_node<image_known>(self, x, limits::image::query_session);
      },
      [self](const image_sharing& x) {
        return ask_node<image_shared>(self, x, limits::image::sharing_session);
      },
      [self](const registration_switch& x) {
        return ask_node<switch_accepted>(self, x,
                                         limits::membership::switching);
      },
      [self](const route_request& x) { return relay(self, x); },
      [self](const log_query& x) {
        const auto wait =
            std::clamp(std::chrono::milliseconds{x.wait_ms},
                       std::chrono::milliseconds{0}, limits::log::wait);
        return ask_node<log_excerpt>(self, x, wait + limits::log::session);
      },
      [self](const kept_logs_query& x) { return list_kept_logs(self, x); },
      [self](const frame_received& frame) { on_frame(self, frame); },
      [self](const heartbeat_received& heartbeat) {
        on_heartbeat(self, heartbeat);
      },
      [self](const session_closed& event) {
        if (is_from_session(self))
          end_member(self, event.reason);
      },
      [self](const close_session& request) {
        end_member(self, request.reason);
      },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
