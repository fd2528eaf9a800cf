#include "actors/site/site_keeper.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "messages/event_kinds.hpp"

#include <utility>

namespace roscell {

namespace {

site_status describe_site(site_keeper_pointer self) {
  const auto& st = self->state;
  site_status result;
  result.trust = st.config.identity ? "identity" : "token";
  if (!st.config.identity)
    return result;
  const auto own = st.config.identity->own();
  result.site = own.who().site;
  result.digest = st.config.identity->site_digest();
  result.identity = uri_of(own.who());
  result.serial = own.chain.front().serial();
  result.ends_unix_s = own.chain.front().ends_unix_s();
  if (const auto revoked = st.config.identity->trust().site.revoked)
    result.revocations = revoked->number();
  result.issues = st.issuer.has_value();
  for (const auto& x : st.invitations.all(self->clock().now()))
    result.invitations.push_back({x.id, x.name, x.role, x.made_unix_ms});
  return result;
}

/// A coordinator without it lets in only those whose identities were made
/// elsewhere.
void take_up_issuer(site_keeper_pointer self) {
  auto& st = self->state;
  if (!st.config.coordinator || !st.config.identity)
    return;
  auto read = read_issuing(st.config.file);
  if (const auto* why = std::get_if<edge_error>(&read))
    return st.config.context.publish_event(events::edge_problem, "",
                                           {{"message", why->message}});
  auto& found = std::get<std::optional<own_identity>>(read);
  if (found && found->who().role == site_role::issuer
      && found->site.digest() == st.config.identity->site_digest())
    st.issuer = std::move(found);
}

} // namespace

caf::error refuse_while_changing(site_keeper_pointer self) {
  const auto& st = self->state;
  if (!st.is_changing)
    return caf::none;
  return fail(error_code::conflict,
              "node '" + st.config.node
                  + "' is about to take the identity that it was given",
              "", "ask again in some seconds");
}

int64_t site_time_s(site_keeper_pointer self) {
  constexpr int64_t ms = 1000;
  const auto& identity = self->state.config.identity;
  return identity ? identity->trust().unix_s : unix_now_ms() / ms;
}

site_keeper_actor::behavior_type site_keeper(site_keeper_pointer self,
                                             const site_keeper_config& config) {
  self->state.config = config;
  self->state.issued = read_issued(config.file);
  config.known->add(config.node, config.uuid);
  for (const auto& [uuid, name] : self->state.issued)
    config.known->add(name, uuid);
  take_up_issuer(self);
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of(
            {{"identity", st.config.identity != nullptr},
             {"issues", st.issuer.has_value()},
             {"issued", st.issued},
             {"changing", st.is_changing},
             {"invitations", st.invitations.all(self->clock().now()).size()}});
      },
      [self](const site_query&) { return describe_site(self); },
      [self](const site_invitation& x) { return keep_invitation(self, x); },
      [self](const site_entry& x) { return let_in(self, x); },
      [self](const site_renewal& x) { return renew_other(self, x); },
      [self](const identity_request_query&) { return request_identity(self); },
      [self](const identity_setting& x) { return set_identity(self, x); },
      [self](const revocation_setting& x) { return set_revocations(self, x); },
      [self](const note_coordinator& x) { meet_coordinator(self, x); },
      [self](const renewal_answered& x) { take_renewal(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          look_at_time(self);
      },
  };
}

} // namespace roscell
