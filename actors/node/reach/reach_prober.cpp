#include "actors/node/reach/reach_prober.hpp"

#include "actors/edge/reach/reach_tries.hpp"
#include "actors/house/edge_failure.hpp"
#include "actors/house/limits.hpp"
#include "actors/house/program_version.hpp"

#include <caf/send.hpp>

#include <utility>

namespace roscell {

namespace {

using reach_prober_self =
    reach_prober_actor::stateful_pointer<reach_prober_state>;

int64_t unix_now_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch())
      .count();
}

reach_opened opened(reach_prober_self self, std::string discovery_server) {
  const auto& st = self->state;
  return {st.config.node,
          program_version,
          st.config.http_address,
          std::move(discovery_server),
          st.port ? st.port->port() : uint16_t{0},
          unix_now_us()};
}

/// A member's own discovery server is what its programs use: after the
/// semicolons that say its id.
std::string server_of(const membership_state& x) {
  const auto i = x.environment.find("ROS_DISCOVERY_SERVER");
  return i == x.environment.end()
             ? std::string{}
             : i->second.substr(i->second.find_last_of(';') + 1);
}

caf::result<reach_opened> open(reach_prober_self self) {
  auto& st = self->state;
  if (!st.port) {
    auto port = reach_port::open(
        *st.config.io, {st.config.address, st.config.domain_id, st.config.key});
    if (const auto* why = std::get_if<edge_error>(&port))
      return to_caf(*why);
    st.port = std::get<std::unique_ptr<reach_port>>(std::move(port));
  }
  st.closing = alarm{};
  st.closing.set(self, self->clock().now() + reach_port_life);
  if (!st.config.membership)
    return opened(self, st.config.discovery_server);
  auto promise = self->make_response_promise<reach_opened>();
  self->request(st.config.membership, limits::local::part, membership_query{})
      .then(
          [self, promise](const membership_state& x) mutable {
            promise.deliver(opened(self, server_of(x)));
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

caf::result<reach_report> look(reach_prober_self self,
                               const reach_query& query) {
  auto& st = self->state;
  const auto question = ++st.last_question;
  const auto promise = self->make_response_promise<reach_report>();
  st.questions.emplace(question, promise);
  try_to_reach(
      {st.config.io->core(), st.config.address, st.config.key}, query.goals,
      [me = reach_prober_actor{self}, question](std::vector<reach_row> rows) {
        caf::anon_send(me, reach_settled{question, std::move(rows)});
      });
  return promise;
}

void on_settled(reach_prober_self self, const reach_settled& fact) {
  if (auto asked = self->state.questions.extract(fact.question))
    asked.mapped().deliver(reach_report{self->state.config.node, fact.rows});
}

} // namespace

reach_prober_actor::behavior_type
reach_prober(reach_prober_self self, const reach_prober_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"questions", st.last_question},
                         {"pending", st.questions.size()},
                         {"port", st.port ? st.port->port() : 0}});
      },
      [self](const reach_opening&) { return open(self); },
      [self](const reach_query& x) { return look(self, x); },
      [self](const reach_settled& x) { on_settled(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.closing.rings(number))
          self->state.port.reset();
      },
  };
}

} // namespace roscell
