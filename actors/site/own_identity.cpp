#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/site/limits.hpp"
#include "actors/site/site_keeper.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>

/// What becomes of a node's own identity.
namespace roscell {

namespace {

site_role own_role(site_keeper_pointer self) {
  return self->state.config.coordinator ? site_role::coordinator
                                        : site_role::node;
}

caf::error misfit(const std::string& why, const std::string& where) {
  return fail(error_code::schema_violation, why, where,
              "`roscell site adopt` and `roscell site renew` make it");
}

/// Of the keys that this node has asked with, and for this node.
caf::expected<own_identity> read_own(site_keeper_pointer self,
                                     const identity_setting& x) {
  const auto& st = self->state;
  if (!st.asked)
    return misfit("node '" + st.config.node + "' has asked for no identity",
                  "/chain");
  auto read = read_identity(st.asked->own.pem() + x.chain + x.site);
  if (const auto* why = std::get_if<edge_error>(&read))
    return misfit(why->message, "/chain");
  auto& own = std::get<own_identity>(read);
  const auto& who = own.who();
  if (who.name != st.config.node || who.uuid != st.config.uuid
      || who.role != own_role(self))
    return misfit("it is of " + text_of(who) + " with UUID " + who.uuid,
                  "/chain");
  const auto found = check_chain(
      {own.site, nullptr}, own.chain,
      trusted_now(unix_now_ms() / 1000, 0, own.chain.front().begins_unix_s()));
  if (const auto* why = std::get_if<distrusted>(&found))
    return misfit(why->text, "/chain");
  return std::move(own);
}

/// Empty: none was given.
caf::expected<std::string> read_issuing_text(site_keeper_pointer self,
                                             const identity_setting& x) {
  const auto& asked = self->state.asked;
  if (x.issuing.empty())
    return std::string{};
  if (!asked->issuing)
    return misfit("node '" + self->state.config.node + "' is no coordinator",
                  "/issuing");
  auto read = read_identity(asked->issuing->pem() + x.issuing + x.site);
  if (const auto* why = std::get_if<edge_error>(&read))
    return misfit(why->message, "/issuing");
  const auto& made = std::get<own_identity>(read);
  if (made.who().role != site_role::issuer)
    return misfit("it is of " + text_of(made.who()) + ", and no issuer's",
                  "/issuing");
  return text_of(made);
}

/// A member goes on with its token while that has a session.
void change_over(site_keeper_pointer self) {
  auto& st = self->state;
  st.is_changing = true;
  const bool bound =
      !st.config.coordinator && st.coordinator && st.coordinator->present;
  if (!bound)
    st.timer.set(self, self->clock().now() + limits::site::answer);
}

/// What it has got is of the same site as what it is.
void take_now(site_keeper_pointer self, const own_identity& own,
              const std::string& issuing) {
  auto& st = self->state;
  st.config.identity->renew(own);
  auto read = read_identity(issuing);
  if (auto* made = std::get_if<own_identity>(&read))
    st.issuer = std::move(*made);
}

} // namespace

void publish_identity(site_keeper_pointer self, const own_identity& own,
                      bool later) {
  const auto& config = self->state.config;
  config.context.publish_event(
      events::identity_taken, config.node,
      {{"identity", uri_of(own.who())},
       {"ends_unix_s", own.chain.front().ends_unix_s()},
       {"later", later}});
}

/// False: it is no list of this site.
bool take_list_of_revoked(site_keeper_pointer self, const std::string& text) {
  auto& st = self->state;
  auto list = revocation_list::read(text, st.config.identity->own().site);
  if (!list)
    return false;
  const auto number = list->number();
  const auto size = list->serials().size() + list->owners().size();
  if (!st.config.identity->take_revoked(std::move(*list)))
    return true;
  if (const auto why = keep_revoked(st.config.file, text))
    st.config.context.publish_event(events::edge_problem, "",
                                    {{"message", why->message}});
  st.config.context.publish_event(events::revocations_taken, "-",
                                  {{"number", number}, {"revoked", size}});
  return true;
}

caf::result<identity_requested> request_identity(site_keeper_pointer self) {
  auto& st = self->state;
  st.asked = asked_keys{private_key::make(), {}};
  identity_requested result;
  result.node = st.config.node;
  result.uuid = st.config.uuid;
  result.coordinator = st.config.coordinator;
  result.request = to_hex(st.asked->own.request());
  if (!st.config.coordinator)
    return result;
  st.asked->issuing = private_key::make();
  result.issuing = to_hex(st.asked->issuing->request());
  return result;
}

caf::result<identity_set> set_identity(site_keeper_pointer self,
                                       const identity_setting& x) {
  auto& st = self->state;
  const auto own = read_own(self, x);
  if (!own)
    return own.error();
  const auto issuing = read_issuing_text(self, x);
  if (!issuing)
    return issuing.error();
  const auto& site = own->site;
  if (!x.revoked.empty() && !revocation_list::read(x.revoked, site))
    return misfit("that is no list of the revoked of its site", "/revoked");
  if (const auto why =
          keep_identity(st.config.file, {*own, *issuing, x.revoked}))
    return to_caf(*why);
  st.asked.reset();
  const bool later =
      !st.config.identity || st.config.identity->site_digest() != site.digest();
  if (later)
    change_over(self);
  else
    take_now(self, *own, *issuing);
  publish_identity(self, *own, later);
  return identity_set{uri_of(own->who()), own->chain.front().ends_unix_s(),
                      later};
}

caf::result<revocations_set> set_revocations(site_keeper_pointer self,
                                             const revocation_setting& x) {
  if (!self->state.config.identity)
    return fail(error_code::conflict,
                "node '" + self->state.config.node
                    + "' has no identity, and so revokes none",
                "", "`roscell site adopt` gives a cell identities");
  if (auto why = refuse_while_changing(self))
    return why;
  if (!take_list_of_revoked(self, x.list))
    return misfit("that is no list of the revoked of this node's site",
                  "/list");
  const auto list = self->state.config.identity->trust().site.revoked;
  return revocations_set{
      list->number(),
      static_cast<int64_t>(list->serials().size() + list->owners().size())};
}

} // namespace roscell
