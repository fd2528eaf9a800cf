#include "actors/node/node_metrics.hpp"

#include "actors/core/answer_limits.hpp"

#include <caf/typed_response_promise.hpp>

#include <utility>

namespace roscell {

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
