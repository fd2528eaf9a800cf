#include "actors/node/node_agent.hpp"

#include "actors/builds/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/instances/limits.hpp"
#include "actors/placement/reservation.hpp"
#include "actors/placement/search/report/text.hpp"

#include <caf/expected.hpp>
#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <utility>

namespace roscell {

namespace {

using node_agent_self = local_agent_actor::stateful_pointer<node_agent_state>;

/// Hands a request on and its answer back.
template <class Reply, class Message>
caf::result<Reply> forward(node_agent_self self,
                           std::chrono::milliseconds timeout,
                           const Message& message) {
  auto promise = self->make_response_promise<Reply>();
  self->request(self->state.config.supervisor, timeout, message)
      .then([promise](Reply& x) mutable { promise.deliver(std::move(x)); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
  return promise;
}

/// A node without an engine has no images.
template <class Reply, class Message>
caf::result<Reply> ask_images(node_agent_self self, const Message& message,
                              std::chrono::milliseconds timeout) {
  if (!self->state.builds.images)
    return fail(error_code::conflict, "node '" + self->state.config.node
                                          + "' has no container engine");
  auto promise = self->make_response_promise<Reply>();
  self->request(self->state.builds.images, timeout, message)
      .then([promise](Reply& x) mutable { promise.deliver(std::move(x)); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
  return promise;
}

/// The session leader of a process instance, whose id is "<pid>:<start>".
/// Engines have other ids.
std::optional<int64_t> session_of(const instance_row& instance) {
  int64_t pid = 0;
  const auto* end = instance.container.data() + instance.container.size();
  const auto read = std::from_chars(instance.container.data(), end, pid);
  if (read.ec != std::errc{} || read.ptr == end || *read.ptr != ':')
    return std::nullopt;
  return pid;
}

/// An instance that the supervisor knows counts as such, whatever its state.
void add_reservations(node_agent_self self,
                      const std::vector<instance_row>& instances,
                      resource_report& to) {
  std::set<std::string> known;
  for (const auto& x : instances)
    known.insert(x.spec.instance);
  for (const auto& spec : self->state.kept.open(self->clock().now(), known)) {
    reserve(to.resources, spec.resources, spec.gpu);
    to.reserved.push_back(spec.instance);
  }
}

/// What the node has and what of it is in use, room that is kept included.
resource_report complete(node_agent_self self, node_resources resources,
                         const std::vector<instance_row>& instances) {
  const auto& config = self->state.config;
  resources.name = config.node;
  resources.labels = config.labels;
  resources.grants = config.grants;
  if (config.secrets)
    resources.secrets = config.secrets->get();
  for (const auto& device : config.devices)
    if (std::find(resources.devices.begin(), resources.devices.end(), device)
        == resources.devices.end())
      resources.devices.push_back(device);
  // Before our instances count: reservations are never floored.
  resources.cpu_compressible =
      compressible_cpu(resources.cpu, config.cpu_floor);
  for (const auto& x : instances)
    if (is_live(x.state))
      reserve(resources, x.spec.resources, x.spec.gpu);
  resource_report result{std::move(resources), {}};
  add_reservations(self, instances, result);
  return result;
}

/// Reads the host, then calls `done` with a report or an error.
void measure(node_agent_self self,
             const std::function<void(caf::expected<resource_report>)>& done) {
  auto on_error = [done](const caf::error& why) { done(why); };
  auto on_known = [self, done, on_error](instance_description& known) {
    measure_host request;
    for (const auto& x : known.instances) {
      if (!is_live(x.state))
        continue;
      if (const auto session = session_of(x))
        request.sessions.push_back(*session);
      else if (!x.container.empty())
        request.containers.push_back(x.container);
    }
    self->request(self->state.config.probe, limits::local::part,
                  std::move(request))
        .then(
            [self, done, known](host_measured& host) {
              done(complete(self, std::move(host.resources), known.instances));
            },
            on_error);
  };
  self->request(self->state.config.supervisor, limits::local::part,
                instance_query{})
      .then(on_known, on_error);
}

caf::result<resource_report> report(node_agent_self self) {
  ++self->state.reports;
  auto promise = self->make_response_promise<resource_report>();
  measure(self, [promise](caf::expected<resource_report> x) mutable {
    if (x)
      promise.deliver(std::move(*x));
    else
      promise.deliver(std::move(x.error()));
  });
  return promise;
}

/// Keeps room for an instance, if there is some; else says why not.
std::optional<std::string> keep_room(node_agent_self self, node_resources& node,
                                     const instance_spec& spec) {
  const auto missing = shortages(node, spec.resources, spec.gpu);
  if (!missing.empty())
    return allocation::enumerated(missing);
  if (auto why = self->state.kept.keep(spec, self->clock().now()))
    return why;
  reserve(node, spec.resources, spec.gpu);
  return std::nullopt;
}

/// What a task had before is given up, so that a repeated one counts once.
caf::result<instances_reserved> keep(node_agent_self self,
                                     const instance_reservation& request) {
  self->state.kept.give_up(request.task, "");
  auto promise = self->make_response_promise<instances_reserved>();
  measure(self, [=](caf::expected<resource_report> now) mutable {
    if (!now) {
      promise.deliver(std::move(now.error()));
      return;
    }
    instances_reserved reply;
    if (request.cpu_floor)
      read_with_cpu_floor(now->resources);
    for (const auto& spec : request.specs)
      if (auto why = keep_room(self, now->resources, spec))
        reply.refused.push_back({spec.instance, *why});
    promise.deliver(std::move(reply));
  });
  return promise;
}

/// Room is kept until the instance runs or has failed: from the supervisor's
/// first word of it on, it counts there.
caf::result<instance_deployed> deploy(node_agent_self self,
                                      const instance_deployment& request) {
  auto promise = self->make_response_promise<instance_deployed>();
  const auto refuse = [self, promise, request](const caf::error& why) mutable {
    self->state.kept.give_up(request.spec.task, request.spec.instance);
    promise.deliver(why);
  };
  with_build(
      self, request,
      [self, promise, request, refuse] {
        self->request(self->state.config.supervisor,
                      limits::task::agent_deployment, request)
            .then(
                [promise](instance_deployed& x) mutable {
                  promise.deliver(std::move(x));
                },
                refuse);
      },
      refuse);
  return promise;
}

} // namespace

local_agent_actor::behavior_type node_agent(node_agent_self self,
                                            const node_agent_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of(
            {{"node", self->state.config.node},
             {"reports", self->state.reports},
             {"reservations",
              self->state.kept.open(self->clock().now(), {}).size()}});
      },
      [self](const resource_query&) { return report(self); },
      [self](const figures_query&) { return report_metrics(self); },
      [self](const instance_reservation& x) { return keep(self, x); },
      [self](const instance_deployment& x) { return deploy(self, x); },
      [self](const instance_removal& x) {
        self->state.kept.give_up(x.task, x.instance);
        return forward<instances_removed>(self, limits::task::agent_removal, x);
      },
      [self](const set_parameters& x) {
        return forward<parameters_set>(self, limits::instance::parameters, x);
      },
      [self](const log_query& x) {
        return forward<log_excerpt>(
            self, limits::log::agent + std::chrono::milliseconds{x.wait_ms}, x);
      },
      [self](const kept_logs_query& x) {
        return forward<kept_logs>(self, limits::history::list, x);
      },
      [self](const build_keeping& x) { return keep_build(self, x); },
      [self](const build_release& x) { return release_build(self, x); },
      [self](const image_query& x) {
        return ask_images<image_known>(self, x, limits::image::query);
      },
      [self](const image_sharing& x) {
        return ask_images<image_shared>(self, x, limits::image::sharing);
      },
      [self](const serve_builds& x) { self->state.builds = x; },
      [self](const use_settings& x) {
        auto& mine = self->state.config;
        mine.labels = x.labels;
        mine.devices = x.devices;
        mine.cpu_floor = x.cpu_floor;
      },
  };
}

namespace {

/// What the skills of live instances have last said.
figures_report metrics_report_of(const instance_description& known) {
  figures_report result;
  for (const auto& x : known.instances)
    if (is_live(x.state))
      result.instances.push_back({x.spec.instance, x.status, x.metrics});
  return result;
}

void add_use(const use_measured& measured, figures_report& to) {
  for (const auto& x : measured.instances)
    for (auto& word : to.instances)
      if (word.instance == x.instance)
        word.metrics.use = x.use;
}

using metrics_promise = caf::typed_response_promise<figures_report>;

/// What the host says of those instances, if it can.
void complete_metrics(node_agent_pointer self,
                      const instance_description& known,
                      metrics_promise promise) {
  auto report = metrics_report_of(known);
  measure_use request;
  for (const auto& x : known.instances)
    if (is_live(x.state) && !x.container.empty())
      request.instances.push_back({x.spec.instance, x.container});
  if (request.instances.empty()) {
    promise.deliver(std::move(report));
    return;
  }
  self->request(self->state.config.probe, limits::local::part,
                std::move(request))
      .then(
          [promise, report](const use_measured& x) mutable {
            add_use(x, report);
            promise.deliver(std::move(report));
          },
          [promise, report](const caf::error&) mutable {
            promise.deliver(std::move(report));
          });
}

} // namespace

caf::result<figures_report> report_metrics(node_agent_pointer self) {
  auto promise = self->make_response_promise<figures_report>();
  self->request(self->state.config.supervisor, limits::local::part,
                instance_query{})
      .then(
          [self, promise](const instance_description& known) {
            complete_metrics(self, known, promise);
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

} // namespace roscell
