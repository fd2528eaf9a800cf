#include "actors/membership/join_scout.hpp"

#include "actors/edge/io/name_lookup.hpp"
#include "actors/edge/session/address_scout.hpp"
#include "actors/house/limits.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <utility>

namespace roscell {

namespace {

using join_scout_self = join_scout_actor::stateful_pointer<join_scout_state>;

caf::result<host_resolved> resolve(join_scout_self self,
                                   const resolve_host& wish) {
  auto& st = self->state;
  const auto question = ++st.last_question;
  const auto promise = self->make_response_promise<host_resolved>();
  st.names.emplace(question, promise);
  look_up_host(
      st.config.io->core(), wish.host, limits::membership::naming,
      [me = join_scout_actor{self}, question](edge_result<std::string> found) {
        scout_settled fact;
        fact.question = question;
        if (const auto* why = std::get_if<edge_error>(&found))
          fact.problem = {why->code, why->message, "", why->hint, ""};
        else
          fact.address = std::get<std::string>(std::move(found));
        caf::anon_send(me, std::move(fact));
      });
  return promise;
}

caf::result<address_scouted> look(join_scout_self self,
                                  const scout_address& wish) {
  auto& st = self->state;
  const auto question = ++st.last_question;
  const auto promise = self->make_response_promise<address_scouted>();
  st.addresses.emplace(question, promise);
  scout(st.config.io->core(), st.config.address, {wish.address, wish.port},
        [me = join_scout_actor{self}, question](address_scouted found) {
          scout_settled fact;
          fact.question = question;
          fact.scouted = std::move(found);
          caf::anon_send(me, std::move(fact));
        });
  return promise;
}

void on_settled(join_scout_self self, const scout_settled& fact) {
  auto& st = self->state;
  if (auto address = st.addresses.extract(fact.question)) {
    address.mapped().deliver(fact.scouted);
    return;
  }
  auto asked = st.names.extract(fact.question);
  if (!asked)
    return;
  if (fact.address.empty())
    asked.mapped().deliver(to_error(fact.problem));
  else
    asked.mapped().deliver(host_resolved{fact.address});
}

} // namespace

join_scout_actor::behavior_type join_scout(join_scout_self self,
                                           const join_scout_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of({{"questions", self->state.last_question},
                         {"pending", self->state.names.size()
                                         + self->state.addresses.size()}});
      },
      [self](const resolve_host& wish) { return resolve(self, wish); },
      [self](const scout_address& wish) { return look(self, wish); },
      [self](const scout_settled& fact) { on_settled(self, fact); },
  };
}

} // namespace roscell
