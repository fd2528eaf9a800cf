#include "actors/requests/metrics/scrape.hpp"

#include "actors/house/limits.hpp"
#include "actors/requests/metrics/cell_metrics.hpp"

#include <optional>
#include <utility>

namespace roscell {

namespace {

/// One scrape, as the answers come in.
struct scrape_state {
  static constexpr const char* name = "scrape";

  std::shared_ptr<const node_services> services;
  exposition_format format = exposition_format::text;
  size_t open = 0;
  std::optional<node_description> node;
  std::optional<cell_description> cell;
  std::optional<instance_description> instances;
};

using scrape_pointer = introspected_actor::stateful_pointer<scrape_state>;

std::string text_of(const scrape_state& st) {
  exposition result{st.format};
  if (st.node)
    write_cost(read_own_cost(), *st.node, result);
  if (st.cell)
    write_cell(*st.cell, result);
  else if (st.node)
    write_node(*st.node, result);
  if (st.instances)
    write_instances(st.instances->instances, result);
  if (const auto& book = st.services->context.metrics)
    for (size_t i = 0; i < metric_count; ++i)
      result.write(static_cast<metric>(i), *book);
  return result.finish();
}

void finish_one(scrape_pointer self, const responder& answer) {
  auto& st = self->state;
  if (--st.open > 0)
    return;
  answer.reply(200, content_type_of(st.format), text_of(st));
  self->quit();
}

template <class Reply, class Handle, class Query>
void ask(scrape_pointer self, const responder& answer, const Handle& whom,
         Query query, std::optional<Reply> scrape_state::*where) {
  if (!whom)
    return;
  ++self->state.open;
  self->request(whom, limits::local::answer, std::move(query))
      .then(
          [self, answer, where](Reply& reply) {
            self->state.*where = std::move(reply);
            finish_one(self, answer);
          },
          [self, answer](const caf::error&) { finish_one(self, answer); });
}

introspected_actor::behavior_type
scrape(scrape_pointer self,
       const std::shared_ptr<const node_services>& services,
       const responder& answer, exposition_format format) {
  auto& st = self->state;
  st.services = services;
  st.format = format;
  st.open = 1;
  ask(self, answer, services->node, node_query{}, &scrape_state::node);
  ask(self, answer, services->coordinator, cell_query{}, &scrape_state::cell);
  if (services->coordinator)
    ask(self, answer, services->coordinator, instance_query{},
        &scrape_state::instances);
  else
    ask(self, answer, services->supervisor, instance_query{},
        &scrape_state::instances);
  finish_one(self, answer);
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
