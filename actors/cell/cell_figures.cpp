#include "actors/cell/cell_figures.hpp"

#include "actors/cell/tasks/task_views.hpp"
#include "actors/house/limits.hpp"

#include <caf/typed_response_promise.hpp>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace roscell {

namespace {

using words_by_instance = std::map<std::string, instance_word>;

/// The words of several nodes, as the answers come in.
struct word_tally {
  size_t open = 0;
  instance_query query;
  std::map<std::string, words_by_instance> nodes;
  caf::typed_response_promise<instance_description> promise;
};

/// What was told of a live instance earlier is outdated, what is told of one
/// that has ended is final.
void add_word(instance_row& row, const word_tally& tally) {
  if (!is_live(row.state))
    return;
  row.figures = {};
  const auto node = tally.nodes.find(row.node);
  if (node == tally.nodes.end())
    return;
  const auto word = node->second.find(row.spec.instance);
  if (word == node->second.end())
    return;
  row.figures = word->second.figures;
  // While an image is built, the coordinator has been told the step of it.
  if (!word->second.status.empty())
    row.status = word->second.status;
}

void complete_tally(coordinator_pointer self, word_tally& tally) {
  if (--tally.open > 0)
    return;
  auto result = describe_instances(self->state, tally.query);
  if (!result) {
    tally.promise.deliver(std::move(result.error()));
    return;
  }
  for (auto& row : result->instances)
    add_word(row, tally);
  tally.promise.deliver(std::move(*result));
}

void ask_node(coordinator_pointer self, const std::string& node,
              const std::shared_ptr<word_tally>& tally) {
  const auto* entry = self->state.registry.find_name(node);
  if (!entry || !entry->agent)
    return complete_tally(self, *tally);
  self->request(entry->agent, limits::resource::collection, figures_query{})
      .then(
          [=](figures_report& report) {
            for (auto& x : report.instances)
              tally->nodes[node].emplace(x.instance, std::move(x));
            complete_tally(self, *tally);
          },
          [=](const caf::error&) { complete_tally(self, *tally); });
}

} // namespace

caf::result<instance_description>
describe_instances_now(coordinator_pointer self, const instance_query& query) {
  auto known = describe_instances(self->state, query);
  if (!known)
    return std::move(known.error());
  std::set<std::string> nodes;
  for (const auto& row : known->instances)
    if (is_live(row.state))
      nodes.insert(row.node);
  auto tally = std::make_shared<word_tally>();
  tally->query = query;
  tally->promise = self->make_response_promise<instance_description>();
  tally->open = nodes.size() + 1;
  for (const auto& node : nodes)
    ask_node(self, node, tally);
  auto promise = tally->promise;
  complete_tally(self, *tally);
  return promise;
}

} // namespace roscell
