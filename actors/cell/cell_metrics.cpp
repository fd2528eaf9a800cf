#include "actors/cell/cell_questions.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/streams/cell_streams.hpp"
#include "actors/cell/tasks/task_views.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace roscell {

namespace {

struct metrics_tally : open_questions {
  std::set<std::string> reported; ///< The nodes that have answered.
};

void ask_node(coordinator_pointer self, const registry_entry& entry,
              const std::shared_ptr<metrics_tally>& tally) {
  const auto node = entry.row.identity.name;
  ++tally->open;
  self->request(entry.agent, limits::resource::collection, figures_query{})
      .then(
          [=](const figures_report& report) {
            self->state.deployments.note_status_texts(node, report.instances);
            tally->reported.insert(node);
            tally->finish_one();
          },
          [=](const caf::error&) {
            self->state.deployments.note_status_texts(node, {});
            tally->finish_one();
          });
}

void ask_nodes(coordinator_pointer self, const std::set<std::string>& nodes,
               std::function<void()> on_all) {
  auto tally = std::make_shared<metrics_tally>();
  tally->on_all = [self, known = tally.get(), on_all = std::move(on_all)] {
    judge_streams(self, known->reported);
    on_all();
  };
  for (const auto& node : nodes) {
    const auto* entry = self->state.registry.find_name(node);
    if (entry && entry->agent)
      ask_node(self, *entry, tally);
  }
  tally->finish_one();
}

/// Whom to ask before the instances of a task are judged; empty: all.
std::set<std::string> nodes_to_ask(const cell_coordinator_state& st,
                                   const std::string& task) {
  const auto all = st.deployments.all_reported();
  auto some = all;
  some.erase(std::remove_if(some.begin(), some.end(),
                            [&](const auto* row) {
                              return !task.empty() && row->spec.task != task;
                            }),
             some.end());
  return nodes_around(all, some);
}

} // namespace

caf::result<instance_description> instances_now(coordinator_pointer self,
                                                const instance_query& query) {
  auto known = describe_instances(self->state, query);
  if (!known)
    return std::move(known.error());
  // The other ends of its streams are known together with its own.
  const auto task =
      query.instance.empty() ? query.task : known->instances.front().spec.task;
  auto promise = self->make_response_promise<instance_description>();
  ask_nodes(self, nodes_to_ask(self->state, task), [=]() mutable {
    auto result = describe_instances(self->state, query);
    if (result)
      promise.deliver(std::move(*result));
    else
      promise.deliver(std::move(result.error()));
  });
  return promise;
}

caf::result<metrics_collected> collect_all_metrics(coordinator_pointer self) {
  auto promise = self->make_response_promise<metrics_collected>();
  ask_nodes(self, self->state.deployments.nodes_with_live(),
            [=]() mutable { promise.deliver(metrics_collected{}); });
  return promise;
}

void check_stream_health(coordinator_pointer self, const std::string& task) {
  ask_nodes(self, nodes_to_ask(self->state, task), [] {
    // Nobody waits for it.
  });
}

cell_measured measured(const cell_coordinator_state& st) {
  cell_measured result;
  for (auto& node : st.registry.rows()) {
    const auto& name = node.identity.name;
    // A name may be on its way from one machine to another; a scraper wants it
    // once.
    if (const auto* owner = st.registry.find_name(name);
        owner == nullptr || owner->row.identity.uuid != node.identity.uuid)
      continue;
    const bool away = !is_present(st, name);
    for (auto& x : st.deployments.measures_on(name, away)) {
      if (away && is_live(x.state))
        x.metrics = {};
      x.health = health_of(st, x.instance, x.state, x.health);
      result.instances.push_back(std::move(x));
    }
    node.resources.name = name;
    result.nodes.push_back({node.state, std::move(node.resources)});
  }
  result.tasks = count_tasks(st);
  return result;
}

} // namespace roscell
