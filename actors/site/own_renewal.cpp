#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/site/limits.hpp"
#include "actors/site/site_keeper.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <utility>

/// How a node's own certificate and list are kept fresh.
namespace roscell {

namespace {

/// Past that a certificate is renewed.
int64_t half_life_s(const certificate& x) {
  return x.begins_unix_s() + (x.ends_unix_s() - x.begins_unix_s()) / 2;
}

int64_t own_list_number(site_keeper_pointer self) {
  const auto list = self->state.config.identity->trust().site.revoked;
  return list ? list->number() : 0;
}

bool is_past_half_life(site_keeper_pointer self) {
  const auto own = self->state.config.identity->own();
  return own.who().role == site_role::node
         && site_time_s(self) >= half_life_s(own.chain.front());
}

void ask_for_renewal(site_keeper_pointer self, bool certificate) {
  auto& st = self->state;
  const auto place = parse_socket_address(st.coordinator->address);
  if (!place || !st.config.ask)
    return;
  st.is_renewing = true;
  if (certificate)
    st.next_renewal = self->clock().now() + limits::site::renewal_pause;
  site_renewal what;
  what.certificate = certificate;
  http_call call;
  call.to.address = place->address;
  call.to.port = place->port;
  call.to.identity = st.config.identity;
  call.to.uuid = st.coordinator->uuid;
  call.to.protocol = entry_protocol;
  call.method = "POST";
  call.target = std::string{site_path} + "renewal";
  call.body = message_json(what).dump();
  call.timeout = limits::site::renewal;
  call.max_reply_bytes = limits::trust::admission_bytes;
  st.config.ask(call,
                [call, me = site_keeper_actor{self}](http_outcome outcome) {
                  renewal_answered answer;
                  auto result = to_edge_result(std::move(outcome), call);
                  if (const auto* why = std::get_if<edge_error>(&result))
                    answer.problem = why->message;
                  else
                    answer.text = std::get<http_reply>(std::move(result)).body;
                  caf::anon_send(me, std::move(answer));
                });
}

/// It is asked for again after a pause.
void renewal_failed(site_keeper_pointer self, const std::string& why,
                    const std::string& hint = {}) {
  const auto& config = self->state.config;
  self->state.timer.set(self,
                        self->clock().now() + limits::site::renewal_pause);
  config.context.publish_event(events::renewal_failed, config.node,
                               {{"message", why}, {"hint", hint}});
}

void take_certificate(site_keeper_pointer self, const std::string& chain) {
  auto& st = self->state;
  const auto now = st.config.identity->own();
  auto read = read_identity(now.key.pem() + chain + now.site.pem());
  if (const auto* why = std::get_if<edge_error>(&read))
    return renewal_failed(self, why->message);
  const auto& own = std::get<own_identity>(read);
  if (!(own.who() == now.who()))
    return renewal_failed(self, "it is of " + text_of(own.who()));
  if (const auto why = keep_identity(st.config.file, {own}))
    return renewal_failed(self, why->message, why->hint);
  st.config.identity->renew(own);
  publish_identity(self, own, false);
}

/// Asks the coordinator that was met last, if there is something to ask for.
void seek_renewal(site_keeper_pointer self) {
  auto& st = self->state;
  if (!st.config.identity || !st.coordinator || st.is_renewing)
    return;
  const bool wants_list = st.coordinator->revocations > own_list_number(self);
  const bool wants_certificate =
      is_past_half_life(self) && self->clock().now() >= st.next_renewal;
  if (wants_list || wants_certificate)
    ask_for_renewal(self, wants_certificate);
}

} // namespace

void meet_coordinator(site_keeper_pointer self, const note_coordinator& x) {
  auto& st = self->state;
  // What a session has said of him is not forgotten by an attempt that fails.
  if (x.present || !st.coordinator || st.coordinator->address != x.address)
    st.coordinator = x;
  st.coordinator->present = x.present;
  if (st.is_changing) {
    if (!x.present)
      st.timer.set(self, self->clock().now());
    return;
  }
  if (!st.config.identity)
    return;
  if (x.present || st.config.identity->has_ended())
    seek_renewal(self);
  st.timer.set_anew(self, self->clock().now() + limits::site::renewal_look);
}

void take_renewal(site_keeper_pointer self, const renewal_answered& x) {
  auto& st = self->state;
  st.is_renewing = false;
  // Since it was asked the node may have been given what is of another site.
  if (!st.config.identity || st.is_changing)
    return;
  if (!x.problem.empty())
    return renewal_failed(self, x.problem,
                          "it is asked for again after an hour");
  auto parsed = parse_document(x.text);
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || !document->is_object())
    return renewal_failed(self, "the coordinator's answer is no document");
  if (const auto refusal = document->find("error"); refusal != document->end())
    return renewal_failed(self, refusal->value("message", ""),
                          refusal->value("hint", ""));
  auto read = decode<site_entered>(*document);
  if (const auto* why = std::get_if<failure>(&read))
    return renewal_failed(self, why->message);
  const auto& got = std::get<site_entered>(read);
  if (!got.revoked.empty() && !take_list_of_revoked(self, got.revoked))
    renewal_failed(self, "its list of the revoked is not this site's");
  if (!got.chain.empty())
    take_certificate(self, got.chain);
}

void look_at_time(site_keeper_pointer self) {
  auto& st = self->state;
  if (st.is_changing) {
    if (st.config.start_anew)
      st.config.start_anew();
    return;
  }
  seek_renewal(self);
  st.timer.set(self, self->clock().now() + limits::site::renewal_look);
}

} // namespace roscell
