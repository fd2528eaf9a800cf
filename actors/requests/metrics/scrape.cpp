#include "actors/requests/metrics/scrape.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/requests/limits.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

/// One scrape, as the answers come in.
struct scrape_state {
  static constexpr const char* name = "scrape";

  std::shared_ptr<const node_services> services;
  exposition_format format = exposition_format::text;
  size_t open = 0;
  std::optional<node_description> node;
  std::optional<cell_measured> cell;
  std::optional<std::vector<instance_row>> instances;
};

using scrape_pointer = introspected_actor::stateful_pointer<scrape_state>;

std::vector<instance_measures>
measures_of(const std::vector<instance_row>& rows) {
  std::vector<instance_measures> result;
  result.reserve(rows.size());
  for (const auto& row : rows)
    result.push_back(measures_of(row));
  return result;
}

std::string text_of(scrape_pointer self) {
  const auto& st = self->state;
  exposition result{st.format};
  write_cost(read_own_cost(), read_boot_time(), result);
  if (st.services->graph)
    write_participants(st.services->graph->participants(), result);
  if (st.cell) {
    write_cell(*st.cell, result);
    write_instances(st.cell->instances, result);
  }
  if (st.node)
    write_node(st.node->resources, result);
  if (st.instances)
    write_instances(measures_of(*st.instances), result);
  if (const auto& table = st.services->context.metrics)
    for (size_t i = 0; i < metric_count; ++i)
      result.write(static_cast<metric>(i), *table);
  return result.finish();
}

void finish_one(scrape_pointer self, const responder& answer) {
  auto& st = self->state;
  if (--st.open > 0)
    return;
  answer.reply(200, content_type_of(st.format), text_of(self));
  self->quit();
}

template <class Reply, class Handle, class Query, class Take>
void ask(scrape_pointer self, const responder& answer, const Handle& whom,
         Query query, Take take) {
  self->request(whom, limits::local::answer, std::move(query))
      .then(
          [self, answer, take](Reply& reply) {
            take(reply);
            finish_one(self, answer);
          },
          [self, answer](const caf::error&) { finish_one(self, answer); });
}

void ask_node(scrape_pointer self, const responder& answer) {
  auto& st = self->state;
  st.open = 2;
  ask<node_description>(self, answer, st.services->node, node_query{},
                        [&st](auto& x) { st.node = std::move(x); });
  ask<instance_description>(
      self, answer, st.services->supervisor, instance_query{},
      [&st](auto& x) { st.instances = std::move(x.instances); });
}

/// A scraper comes often and wants its answer soon: what nodes have told by
/// then is in it, and what they told before of those that take longer.
void ask_cell(scrape_pointer self, const responder& answer) {
  self->state.open = 1;
  const auto coordinator = self->state.services->coordinator;
  const auto measure = [self, answer, coordinator] {
    ask<cell_measured>(self, answer, coordinator, measure_cell{},
                       [self](auto& x) { self->state.cell = std::move(x); });
  };
  self->request(coordinator, limits::resource::scrape_collection,
                collect_metrics{})
      .then([measure](const metrics_collected&) { measure(); },
            [measure](const caf::error&) { measure(); });
}

introspected_actor::behavior_type
scrape(scrape_pointer self,
       const std::shared_ptr<const node_services>& services,
       const responder& answer, exposition_format format) {
  auto& st = self->state;
  st.services = services;
  st.format = format;
  if (services->coordinator)
    ask_cell(self, answer);
  else
    ask_node(self, answer);
  return {
      [self](const state_query&) {
        return state_of({{"open", self->state.open}});
      },
  };
}

} // namespace

void start_scrape(caf::actor_system& system,
                  const std::shared_ptr<const node_services>& services,
                  const responder& answer, exposition_format format) {
  spawn(system, services->context, scrape, services, answer, format);
}

} // namespace roscell
