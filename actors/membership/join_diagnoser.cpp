#include "actors/membership/join_diagnoser.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/session/address_probe.hpp"
#include "actors/membership/limits.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <utility>

namespace roscell {

namespace {

using join_diagnoser_self =
    join_diagnoser_actor::stateful_pointer<join_diagnoser_state>;

caf::result<host_resolved> resolve(join_diagnoser_self self,
                                   const resolve_host& request) {
  auto& st = self->state;
  const auto question = ++st.last_question;
  const auto promise = self->make_response_promise<host_resolved>();
  st.names.emplace(question, promise);
  look_up_host(st.config.io->core(), request.host, limits::membership::naming,
               [me = join_diagnoser_actor{self},
                question](edge_result<std::string> found) {
                 diagnosis_settled event;
                 event.question = question;
                 if (const auto* why = std::get_if<edge_error>(&found))
                   event.problem = {why->code, why->message, "", why->hint, ""};
                 else
                   event.address = std::get<std::string>(std::move(found));
                 caf::anon_send(me, std::move(event));
               });
  return promise;
}

caf::result<server_probed> look(join_diagnoser_self self,
                                const probe_server& request) {
  auto& st = self->state;
  const auto question = ++st.last_question;
  const auto promise = self->make_response_promise<server_probed>();
  st.addresses.emplace(question, promise);
  probe_address(
      st.config.io->core(), st.config.address, {request.address, request.port},
      st.config.site.identity(),
      [me = join_diagnoser_actor{self}, question](server_probed found) {
        diagnosis_settled event;
        event.question = question;
        event.probed = std::move(found);
        caf::anon_send(me, std::move(event));
      });
  return promise;
}

void on_settled(join_diagnoser_self self, const diagnosis_settled& event) {
  auto& st = self->state;
  if (auto address = st.addresses.extract(event.question)) {
    address.mapped().deliver(event.probed);
    return;
  }
  auto asked = st.names.extract(event.question);
  if (!asked)
    return;
  if (event.address.empty())
    asked.mapped().deliver(to_error(event.problem));
  else
    asked.mapped().deliver(host_resolved{event.address});
}

} // namespace

join_diagnoser_actor::behavior_type
join_diagnoser(join_diagnoser_self self, const join_diagnoser_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of({{"questions", self->state.last_question},
                         {"pending", self->state.names.size()
                                         + self->state.addresses.size()}});
      },
      [self](const resolve_host& request) { return resolve(self, request); },
      [self](const probe_server& request) { return look(self, request); },
      [self](const diagnosis_settled& event) { on_settled(self, event); },
  };
}

} // namespace roscell
