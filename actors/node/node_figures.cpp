#include "actors/node/node_figures.hpp"

#include "actors/house/limits.hpp"

#include <caf/typed_response_promise.hpp>

#include <utility>

namespace roscell {

namespace {

/// What the skills of live instances have last said.
figures_report words_of(const instance_description& known) {
  figures_report result;
  for (const auto& x : known.instances)
    if (is_live(x.state))
      result.instances.push_back({x.spec.instance, x.status, x.figures});
  return result;
}

void add_use(const use_measured& measured, figures_report& to) {
  for (const auto& x : measured.instances)
    for (auto& word : to.instances)
      if (word.instance == x.instance)
        word.figures.use = x.use;
}

using figures_promise = caf::typed_response_promise<figures_report>;

/// What the host says of those instances, if it can.
void complete_figures(node_agent_pointer self,
                      const instance_description& known,
                      figures_promise promise) {
  auto report = words_of(known);
  measure_use wish;
  for (const auto& x : known.instances)
    if (is_live(x.state) && !x.container.empty())
      wish.instances.push_back({x.spec.instance, x.container});
  if (wish.instances.empty()) {
    promise.deliver(std::move(report));
    return;
  }
  self->request(self->state.config.probe, limits::local::part, std::move(wish))
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

caf::result<figures_report> report_figures(node_agent_pointer self) {
  auto promise = self->make_response_promise<figures_report>();
  self->request(self->state.config.supervisor, limits::local::part,
                instance_query{})
      .then(
          [self, promise](const instance_description& known) {
            complete_figures(self, known, promise);
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

} // namespace roscell
