#include "actors/node/reach_prober.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/core/program_version.hpp"
#include "actors/edge/reach/reach_tries.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <charconv>
#include <optional>
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

/// What programs of a member use: its own discovery server, after the
/// semicolons that say its id, in the domain of its cell.
struct program_place {
  std::string server;
  unsigned domain = 0;
};

program_place place_of(const reach_prober_config& config,
                       const std::map<std::string, std::string>& environment) {
  program_place result{config.discovery_server, config.domain_id};
  const auto server = environment.find("ROS_DISCOVERY_SERVER");
  if (server != environment.end())
    result.server = server->second.substr(server->second.find_last_of(';') + 1);
  const auto domain = environment.find("ROS_DOMAIN_ID");
  if (domain != environment.end())
    std::from_chars(domain->second.data(),
                    domain->second.data() + domain->second.size(),
                    result.domain);
  return result;
}

/// Has ports open in the domain for a while from now on.
std::optional<edge_error> keep_open(reach_prober_self self, unsigned domain) {
  auto& st = self->state;
  st.closing.set_anew(self, self->clock().now() + reach_port_life);
  if (st.port && st.port_domain == domain)
    return std::nullopt;
  auto port = reach_port::open(*st.config.io,
                               {st.config.address, domain, st.config.site});
  if (auto* why = std::get_if<edge_error>(&port))
    return std::move(*why);
  st.port = std::get<std::unique_ptr<reach_port>>(std::move(port));
  st.port_domain = domain;
  return std::nullopt;
}

caf::expected<reach_opened>
opened(reach_prober_self self,
       const std::map<std::string, std::string>& environment) {
  const auto& st = self->state;
  auto place = place_of(st.config, environment);
  if (const auto why = keep_open(self, place.domain))
    return to_caf(*why);
  return reach_opened{st.config.node,         program_version,
                      st.config.http_address, std::move(place.server),
                      st.port->port(),        unix_now_us()};
}

caf::result<reach_opened> open(reach_prober_self self) {
  const auto& membership = self->state.config.membership;
  if (!membership)
    return opened(self, {});
  auto promise = self->make_response_promise<reach_opened>();
  self->request(membership, limits::local::part, membership_query{})
      .then(
          [self, promise](const membership_state& x) mutable {
            auto reported = opened(self, x.environment);
            if (reported)
              promise.deliver(std::move(*reported));
            else
              promise.deliver(std::move(reported.error()));
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

caf::result<reach_report> look(reach_prober_self self,
                               const reach_query& query) {
  auto& st = self->state;
  const auto token = st.config.site.text();
  if (token.empty()) {
    const auto lack = st.config.site.what_lacks();
    return fail(error_code::unauthorized,
                "no node answers one that has no site token: " + lack.message,
                "", lack.hint);
  }
  const auto question = ++st.last_question;
  const auto promise = self->make_response_promise<reach_report>();
  st.questions.emplace(question, promise);
  try_to_reach(
      {st.config.io->core(), st.config.address, reach_key(token),
       st.config.site.identity()},
      query.goals,
      [me = reach_prober_actor{self}, question](std::vector<reach_row> rows) {
        caf::anon_send(me, reach_settled{question, std::move(rows)});
      });
  return promise;
}

void on_settled(reach_prober_self self, const reach_settled& event) {
  if (auto asked = self->state.questions.extract(event.question))
    asked.mapped().deliver(reach_report{self->state.config.node, event.rows});
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
