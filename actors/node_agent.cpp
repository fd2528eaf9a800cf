#include "actors/node_agent.hpp"

#include "actors/reservation.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <optional>
#include <utility>

namespace roscell {

namespace {

using self_pointer = node_agent_actor::stateful_pointer<node_agent_state>;

constexpr std::chrono::seconds query_timeout{5};

/// An image may have to be built, with a base image that must be fetched.
constexpr std::chrono::minutes deployment_timeout{15};

/// Grace time, force, and the removal of what is left.
constexpr std::chrono::seconds removal_timeout{35};

constexpr std::chrono::seconds log_margin{5};

/// Hands a request on and its answer back.
template <class Reply, class Message>
caf::result<Reply> forward(self_pointer self, std::chrono::milliseconds timeout,
                           const Message& message) {
  auto promise = self->make_response_promise<Reply>();
  self->request(self->state.config.supervisor, timeout, message)
      .then([promise](Reply& x) mutable { promise.deliver(std::move(x)); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
  return promise;
}

/// The session leader of a process instance, whose id is "<pid>:<start>".
/// Engines have other ids; what their containers use is not subtracted.
std::optional<int64_t> session_of(const instance_row& instance) {
  int64_t pid = 0;
  const auto* end = instance.container.data() + instance.container.size();
  const auto read = std::from_chars(instance.container.data(), end, pid);
  if (read.ec != std::errc{} || read.ptr == end || *read.ptr != ':')
    return std::nullopt;
  return pid;
}

resource_report complete(const node_agent_config& config,
                         node_resources resources,
                         const std::vector<instance_row>& instances) {
  resources.name = config.node;
  resources.labels = config.labels;
  for (const auto& device : config.devices)
    if (std::find(resources.devices.begin(), resources.devices.end(), device)
        == resources.devices.end())
      resources.devices.push_back(device);
  for (const auto& x : instances)
    if (is_live(x.state))
      reserve(resources, x.spec.resources, x.spec.gpu);
  return {std::move(resources)};
}

using report_promise = caf::typed_response_promise<resource_report>;

void measure(self_pointer self, instance_description known,
             report_promise promise) {
  measure_host wish;
  for (const auto& x : known.instances)
    if (const auto session = session_of(x); session && is_live(x.state))
      wish.sessions.push_back(*session);
  self->request(self->state.config.probe, query_timeout, std::move(wish))
      .then(
          [self, promise, known](host_measured& host) mutable {
            promise.deliver(complete(self->state.config,
                                     std::move(host.resources),
                                     known.instances));
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
}

caf::result<resource_report> report(self_pointer self) {
  ++self->state.reports;
  auto promise = self->make_response_promise<resource_report>();
  self->request(self->state.config.supervisor, query_timeout, instance_query{})
      .then(
          [self, promise](instance_description& known) {
            measure(self, std::move(known), promise);
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

} // namespace

node_agent_actor::behavior_type node_agent(self_pointer self,
                                           const node_agent_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of({{"node", self->state.config.node},
                         {"reports", self->state.reports}});
      },
      [self](const resource_query&) { return report(self); },
      [self](const instance_deployment& x) {
        return forward<instance_deployed>(self, deployment_timeout, x);
      },
      [self](const instance_removal& x) {
        return forward<instances_removed>(self, removal_timeout, x);
      },
      [self](const log_query& x) {
        return forward<log_excerpt>(
            self, log_margin + std::chrono::milliseconds{x.wait_ms}, x);
      },
  };
}

} // namespace roscell
