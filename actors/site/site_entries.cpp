#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/invitation.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/site/site_keeper.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

/// How a coordinator makes others somebody.
namespace roscell {

namespace {

caf::error no_such_invitation() {
  return fail(error_code::unauthorized,
              "there is no such invitation, or it was used, or it is over", "",
              "`roscell site invite` makes another one");
}

caf::error cannot_issue(site_keeper_pointer self) {
  const auto& st = self->state;
  return fail(error_code::conflict,
              st.config.identity
                  ? "node '" + st.config.node
                        + "' makes no identities: it is no coordinator that "
                          "the site has made an issuer"
                  : "node '" + st.config.node
                        + "' has no identity, so it lets nobody into a site",
              "",
              st.config.identity
                  ? "ask a coordinator, or the machine that keeps the site"
                  : "`roscell site adopt` gives a cell identities");
}

/// The sockets that they come to know no actor's clock.
void expect_newcomers(site_keeper_pointer self) {
  const auto now = self->clock().now();
  std::chrono::steady_clock::duration left{};
  for (const auto& x : self->state.invitations.all(now))
    left = std::max(left, x.until - now);
  self->state.config.identity->expect_newcomers(std::chrono::steady_clock::now()
                                                + left);
}

/// The newest there is, for those who may have an older one.
std::string newest_list(site_keeper_pointer self) {
  return read_small_file(revoked_file_of(self->state.config.file),
                         limits::trust::revocations_bytes)
      .value_or("");
}

/// Before it is given away: who is away can be revoked by that.
caf::error note_issued(site_keeper_pointer self, const identity& who) {
  auto& st = self->state;
  auto all = st.issued;
  all[who.uuid] = who.name;
  if (all == st.issued)
    return caf::none;
  if (const auto why = keep_issued(st.config.file, all); !why.empty())
    return fail(error_code::internal, why, "",
                "check whether its disk has room");
  st.issued = std::move(all);
  st.config.known->add(who.name, who.uuid);
  return caf::none;
}

/// A certificate of a node, and whose key has signed it.
std::string issue_chain(site_keeper_pointer self, const identity& who,
                        EVP_PKEY* key, const char* reason) {
  const auto& issuer = *self->state.issuer;
  const auto made =
      make_certificate(who, key, {issuer.key, issuer.chain.front()},
                       site_time_s(self), good_for_of(who.role));
  self->state.config.context.publish_event(events::certificate_issued, who.name,
                                           {{"serial", made.serial()},
                                            {"ends_unix_s", made.ends_unix_s()},
                                            {"reason", reason}});
  return made.pem() + issuer.chain.front().pem();
}

site_entered answer_of(site_keeper_pointer self) {
  site_entered result;
  result.site = self->state.config.identity->own().site.pem();
  result.revoked = newest_list(self);
  return result;
}

/// A name and a UUID that are another one's go with no invitation, and those
/// of one who is known with none that does not name him.
caf::error check_claim(site_keeper_pointer self, const open_invitation& by,
                       const identity& who) {
  if (!by.name.empty() && by.name != who.name)
    return fail(error_code::unauthorized,
                "the invitation is for another node than '" + who.name + "'",
                "/node", "call the node as it says, with --name");
  const auto claim = self->state.config.known->judge(who.name, who.uuid);
  if (claim == known_nodes::claim::taken)
    return fail(error_code::unauthorized,
                "the UUID " + who.uuid + " is of another node than '" + who.name
                    + "'",
                "/uuid", "begin anew with --new-identity");
  if (claim == known_nodes::claim::by_name && by.name.empty())
    return fail(error_code::unauthorized,
                "there has been a node '" + who.name + "'", "/node",
                "`roscell site invite node " + who.name
                    + "` invites it again; --name gives this one another name");
  return caf::none;
}

/// What he has asked for can be made.
std::optional<identity> newcomer_in(site_keeper_pointer self,
                                    const site_entry& x) {
  const identity who{self->state.config.identity->who().site, site_role::node,
                     x.node, x.uuid};
  const auto read = identity_in(uri_of(who));
  return read && *read == who ? read : std::nullopt;
}

/// A certificate for a newcomer who has proved that invitation.
caf::expected<std::string> chain_for(site_keeper_pointer self,
                                     const open_invitation& by,
                                     const site_entry& x) {
  const auto who = newcomer_in(self, x);
  const auto key = key_in_request(from_hex(x.request).value_or(""));
  if (!who || !key)
    return fail(error_code::schema_violation,
                who ? "that is no request for a certificate"
                    : "an identity cannot be of '" + x.node
                          + "' with the UUID '" + x.uuid + "'",
                who ? "/request" : "/node");
  if (auto why = check_claim(self, by, *who))
    return why;
  if (auto why = note_issued(self, *who))
    return why;
  return issue_chain(self, *who, key.get(), "invitation");
}

} // namespace

caf::result<site_invited> keep_invitation(site_keeper_pointer self,
                                          const site_invitation& x) {
  auto& st = self->state;
  if (!st.config.identity || (x.deposit.empty() && !st.issuer))
    return cannot_issue(self);
  if (auto why = refuse_while_changing(self))
    return why;
  if (x.deposit.empty() && x.role != to_word(site_role::node))
    return fail(error_code::schema_violation,
                "a coordinator makes identities of nodes only", "/role",
                "invite on the machine that keeps the site");
  const auto now = self->clock().now();
  open_invitation open;
  open.id = id_of_invitation(x.secret);
  open.proving = x.secret;
  open.name = x.node;
  open.role = x.role;
  open.deposit = x.deposit;
  open.made_unix_ms = unix_now_ms();
  open.until = now + limits::trust::invitation;
  // Asked again, it is the same.
  if (st.invitations.find(open.id, now) == nullptr
      && !st.invitations.add(std::move(open), now))
    return fail(error_code::conflict,
                std::to_string(limits::trust::invitations)
                    + " invitations are open",
                "", "they are over after a day");
  expect_newcomers(self);
  constexpr int64_t ms = 1000;
  return site_invited{st.config.identity->who().site,
                      st.config.identity->site_digest(), st.config.addresses,
                      unix_now_ms() + limits::trust::invitation.count() * ms};
}

caf::result<site_entered> let_in(site_keeper_pointer self,
                                 const site_entry& x) {
  auto& st = self->state;
  if (!st.config.identity)
    return cannot_issue(self);
  if (auto why = refuse_while_changing(self))
    return why;
  const auto now = self->clock().now();
  const auto* open = st.invitations.find(x.invitation, now);
  const auto exported = from_hex(x.exported);
  if (open == nullptr || !exported
      || !proves_invitation(open->proving, *exported, x.proof))
    return no_such_invitation();
  auto result = answer_of(self);
  result.deposit = open->deposit;
  if (open->deposit.empty()) {
    // What is wrong with it costs him no invitation.
    auto chain = chain_for(self, *open, x);
    if (!chain)
      return chain.error();
    result.chain = std::move(*chain);
  }
  st.invitations.use(x.invitation, now);
  expect_newcomers(self);
  return result;
}

caf::result<site_entered> renew_other(site_keeper_pointer self,
                                      const site_renewal& x) {
  auto& st = self->state;
  if (!st.config.identity)
    return cannot_issue(self);
  if (auto why = refuse_while_changing(self))
    return why;
  const auto shown = certificates_in(x.peer, 1);
  if (!shown || shown->empty() || !shown->front().who())
    return fail(error_code::unauthorized, "who asks shows no certificate");
  const auto& who = *shown->front().who();
  auto result = answer_of(self);
  if (!x.certificate)
    return result;
  if (who.role != site_role::node)
    return fail(error_code::unauthorized,
                std::string{"certificates of the role '"} + to_word(who.role)
                    + "' are renewed by the site alone",
                "", "`roscell site renew` on the machine that keeps it");
  if (!st.issuer)
    return cannot_issue(self);
  if (auto why = note_issued(self, who))
    return why;
  result.chain = issue_chain(self, who, shown->front().key(), "renewal");
  return result;
}

} // namespace roscell
