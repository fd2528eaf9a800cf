#include "actors/instances/ros2/graph_watch.hpp"
#include "actors/house/watching.hpp"

#include <caf/actor_cast.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using graph_watch_self = graph_watch_actor::stateful_pointer<graph_watch_state>;

bool has(const std::vector<graph_endpoint>& ends, const std::string& program,
         const std::string& topic, bool writes) {
  return std::any_of(ends.begin(), ends.end(), [&](const auto& x) {
    return x.topic == topic && x.writes == writes
           && (program.empty() || x.program == program);
  });
}

void look(graph_watch_self self, watched_program& x,
          const std::vector<graph_endpoint>& ends) {
  auto missing = missing_in(ends, x.wish);
  if (x.missing == missing)
    return;
  x.missing = missing;
  self->send(x.listener,
             endpoints_missing{x.wish.instance, std::move(missing)});
}

void watch(graph_watch_self self, const watch_endpoints& wish) {
  auto& st = self->state;
  auto listener =
      caf::actor_cast<endpoint_listener_actor>(self->current_sender());
  if (!listener)
    return;
  watch_until_its_end(self, listener);
  auto& x = st.programs[wish.instance];
  x = {wish, listener, std::nullopt};
  look(self, x, st.graph->endpoints());
}

void look_at_all(graph_watch_self self) {
  auto& st = self->state;
  // Nobody is told again before somebody looks.
  if (st.programs.empty())
    return;
  const auto ends = st.graph->endpoints();
  for (auto& [instance, x] : st.programs)
    look(self, x, ends);
}

void forget(graph_watch_self self, const caf::actor_addr& gone) {
  auto& programs = self->state.programs;
  for (auto i = programs.begin(); i != programs.end();)
    i = i->second.listener.address() == gone ? programs.erase(i) : std::next(i);
}

} // namespace

std::vector<std::string> missing_in(const std::vector<graph_endpoint>& ends,
                                    const watch_endpoints& wish) {
  std::vector<std::string> result;
  for (const auto& topic : wish.written)
    if (!has(ends, wish.program, topic, true))
      result.push_back("a writer of " + topic);
  for (const auto& topic : wish.read)
    if (!has(ends, wish.program, topic, false))
      result.push_back("a reader of " + topic);
  return result;
}

graph_watch_actor::behavior_type graph_watch(graph_watch_self self,
                                             std::shared_ptr<ros_graph> graph) {
  self->state.graph = std::move(graph);
  self->set_down_handler(
      [self](const caf::down_msg& down) { forget(self, down.source); });
  // On a thread of Fast DDS, once until the graph is looked at.
  self->state.graph->watch([to = caf::actor_cast<graph_watch_actor>(self)] {
    caf::anon_send(to, graph_changed{});
  });
  self->attach_functor(
      [watched = self->state.graph] { watched->watch(nullptr); });
  return {
      [self](const state_query&) {
        return state_of({{"programs", self->state.programs.size()}});
      },
      [self](const watch_endpoints& wish) { watch(self, wish); },
      [self](const graph_changed&) { look_at_all(self); },
  };
}

} // namespace roscell
