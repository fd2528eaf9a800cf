#include "actors/builds/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/membership/membership_steps.hpp"
#include "actors/session/limits.hpp"
#include "actors/session/session_calls.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

/// How a request of the coordinator is answered, as long as its session is
/// there.
std::function<void(const json&)> answer_to(self_pointer self, uint64_t id) {
  return [self, session = self->state.session.id(), id](const json& body) {
    if (self->state.session && self->state.session.id() == session)
      self->state.frames.answer(id, body);
  };
}

/// Gives a request of the coordinator to the node agent and its answer, or
/// why there is none, back.
template <class Reply, class Request>
void forward(self_pointer self, uint64_t id, const Request& what,
             std::chrono::milliseconds timeout) {
  const auto answer = answer_to(self, id);
  self->request(self->state.parts.agent, timeout - limits::session::margin,
                what)
      .then([answer](const Reply& reply) { answer(message_json(reply)); },
            [answer](const caf::error& why) {
              answer(error_reply(to_failure(why)));
            });
}

template <class Reply, class Request>
void decode_and_forward(self_pointer self, const session_inquiry& x,
                        std::chrono::milliseconds timeout) {
  auto what = decode<Request>(x.body);
  if (auto* why = std::get_if<failure>(&what))
    self->state.frames.answer(*x.id, error_reply(*why));
  else
    forward<Reply>(self, *x.id, std::get<Request>(what), timeout);
}

void forward_log_query(self_pointer self, const session_inquiry& x) {
  const std::chrono::milliseconds wait{x.body.value("wait_ms", int64_t{0})};
  decode_and_forward<log_excerpt, log_query>(
      self, x,
      std::clamp(wait, std::chrono::milliseconds{0}, limits::log::wait)
          + limits::log::session);
}

/// The coordinator moves this node, or lets it go.
void on_switch(self_pointer self, const session_inquiry& x) {
  auto order = decode<registration_switch>(x.body);
  if (auto* why = std::get_if<failure>(&order))
    return self->state.frames.answer(*x.id, error_reply(*why));
  auto reply = [answer = answer_to(self, *x.id)](
                   const caf::expected<switch_accepted>& outcome) {
    answer(outcome ? message_json(*outcome)
                   : error_reply(to_failure(outcome.error())));
  };
  on_coordinators_switch(self, std::get<registration_switch>(order), reply);
}

/// Somebody in the cell wants to know what only this node can tell.
void on_relayed(self_pointer self, const session_inquiry& x,
                std::chrono::milliseconds limit) {
  const auto answer = answer_to(self, *x.id);
  const auto& router = self->state.router;
  if (!router)
    return answer(
        error_reply({error_code::conflict, "the node is still starting"}));
  self->request(router, limit, route_request{x.body.dump(), x.type()})
      .then([answer](const request_routed& reply) { answer(body_of(reply)); },
            [answer](const caf::error& why) {
              answer(error_reply(to_failure(why)));
            });
}

void on_request(self_pointer self, const session_inquiry& x) {
  const auto type = x.type();
  if (type == registration_switch::type)
    return on_switch(self, x);
  if (type == resource_query::type)
    decode_and_forward<resource_report, resource_query>(
        self, x, limits::session::resource_query);
  else if (type == figures_query::type)
    decode_and_forward<figures_report, figures_query>(self, x,
                                                      limits::session::metrics);
  else if (type == instance_reservation::type)
    decode_and_forward<instances_reserved, instance_reservation>(
        self, x, limits::session::resource_query);
  else if (type == instance_deployment::type)
    decode_and_forward<instance_deployed, instance_deployment>(
        self, x, limits::task::deployment);
  else if (type == instance_removal::type)
    decode_and_forward<instances_removed, instance_removal>(
        self, x, limits::task::removal);
  else if (type == set_parameters::type)
    decode_and_forward<parameters_set, set_parameters>(
        self, x, limits::session::parameters);
  else if (type == build_keeping::type)
    decode_and_forward<build_kept, build_keeping>(self, x,
                                                  limits::build::keeping);
  else if (type == build_release::type)
    decode_and_forward<build_released, build_release>(self, x,
                                                      limits::build::disk);
  else if (type == image_query::type)
    decode_and_forward<image_known, image_query>(self, x,
                                                 limits::image::query_session);
  else if (type == image_sharing::type)
    decode_and_forward<image_shared, image_sharing>(
        self, x, limits::image::sharing_session);
  else if (type == log_query::type)
    forward_log_query(self, x);
  else if (type == kept_logs_query::type)
    decode_and_forward<kept_logs, kept_logs_query>(
        self, x, limits::history::member_list);
  else if (const auto limit = relayed_limit(type))
    on_relayed(self, x, *limit);
  else
    self->state.frames.answer(
        *x.id, error_reply({error_code::unknown_type,
                            "a coordinator may not ask for this", "/type"}));
}

/// The coordinator is there after all.
void stop_seeking_coordinators(self_pointer self) {
  if (self->state.phase == phase::joined)
    withdraw_presence_now(self);
}

} // namespace

void take_session(self_pointer self, const session_actor& session) {
  hold_session(self, session, lease_side::member);
  set_timer(self);
}

void drop_session(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  if (!st.session)
    return;
  self->send(st.parts.supervisor, contact_lost{});
  auto session = std::exchange(st.session, nullptr);
  self->demonitor(session.address());
  self->send(session, close_session{reason});
  // Taken away first: nothing that fails now may send on it.
  auto frames = std::exchange(st.frames, session_exchange{});
  frames.calls().fail_all(reason);
}

void on_frame(self_pointer self, const frame_received& frame) {
  const auto x = hear_frame(self, frame);
  stop_seeking_coordinators(self);
  // A notice of the coordinator has no meaning yet; a later version's may.
  if (x && x->id)
    on_request(self, *x);
  if (self->state.frames.hopeless())
    on_session_lost(self, "the coordinator sent frames that make no sense");
  set_timer(self);
}

void on_heartbeat(self_pointer self, const heartbeat_received& heartbeat) {
  hear_heartbeat(self, heartbeat);
  stop_seeking_coordinators(self);
  const auto& st = self->state;
  if (heartbeat.sent_boot_ms > 0 && st.phase == phase::joined)
    self->send(st.parts.supervisor, contact_proven{heartbeat.sent_boot_ms, {}});
}

void on_session_lost(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  switch (st.phase) {
  case phase::asking:
  case phase::registering:
    return attempt_failed(self, reason);
  case phase::accepting:
    return drop_session(self, reason);
  case phase::leaving:
    return finish_leaving(self);
  case phase::joined:
    break;
  default:
    return;
  }
  st.state = node_state::orphaned;
  publish_event(self, events::coordinator_lost,
                {{"cell", st.cell}, {"reason", reason}});
  let_remote_rest(self);
  // One that lasted ends the series of attempts before it.
  if (self->clock().now() - st.joined_at >= limits::lease::span) {
    st.pause.reset();
    st.hurried.reset();
  }
  attempt_failed(self, reason);
}

void notify(self_pointer self, const instance_changed& event) {
  auto& frames = self->state.frames;
  auto x = event;
  x.instance.node = self->state.config.identity.name;
  if (frames.notify(message_json(x)))
    return;
  // The coordinator must hear how it is; the rest it knows.
  shorten(x.instance);
  if (!frames.notify(message_json(x)))
    publish_event(self, events::event_too_large,
                  {{"fact", events::instance_changed.name},
                   {"instance", x.instance.spec.instance},
                   {"state", to_word(x.instance.state)}});
}

void notify_skills(self_pointer self) {
  auto& st = self->state;
  if (!st.skills_heard)
    return;
  const auto& config = st.config;
  if (!st.frames.notify(
          message_json(skills_changed{config.skills, config.refused_skills})))
    publish_event(self, events::event_too_large,
                  {{"fact", skills_changed::type}});
}

namespace {

void stop(self_pointer self, const std::string& instance) {
  auto& st = self->state;
  const auto& rows = *st.instances;
  auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& x) {
    return x.spec.instance == instance;
  });
  if (row == rows.end())
    return;
  self->request(st.parts.agent, limits::task::removal,
                instance_removal{row->spec.task, instance})
      .then([](const instances_removed&) {},
            [self](const caf::error& why) {
              self->state.problem = to_failure(why).message;
            });
}

/// The coordinator counts on this instance: it must hear that it failed also
/// when there never was one that could tell of itself.
void on_start_failed(self_pointer self, const instance_spec& spec,
                     const caf::error& why) {
  auto& st = self->state;
  instance_changed event;
  event.instance.spec = spec;
  event.instance.state = instance_state::failed;
  event.instance.since_unix_ms = unix_now_ms();
  event.instance.reason = to_failure(why).message;
  if (st.phase == membership_phase::joined)
    notify(self, event);
}

void start(self_pointer self, const instance_spec& spec) {
  self->request(self->state.parts.agent, limits::task::deployment,
                instance_deployment{spec})
      .then([](const instance_deployed&) {},
            [self, spec](const caf::error& why) {
              on_start_failed(self, spec, why);
            });
}

} // namespace

void apply(self_pointer self, const std::vector<instance_verdict>& verdicts) {
  for (const auto& x : verdicts) {
    if (x.what == verdict::stop)
      stop(self, x.instance);
    else if (x.what == verdict::start && !x.spec.empty())
      start(self, x.spec.front());
  }
}

} // namespace roscell::membership_steps
