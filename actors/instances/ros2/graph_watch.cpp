#include "actors/instances/ros2/graph_watch.hpp"
#include "actors/core/watching.hpp"

#include <caf/actor_cast.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

using graph_watch_self = graph_watch_actor::stateful_pointer<graph_watch_state>;

/// A node may run hundreds of programs, each of which looks for a few of
/// thousands of ends.
using ends_by_program = std::multimap<std::string_view, const graph_endpoint*>;

ends_by_program sorted(const std::vector<graph_endpoint>& ends) {
  ends_by_program result;
  for (const auto& x : ends)
    result.emplace(x.program, &x);
  return result;
}

bool has(const ends_by_program& ends, const std::string& program,
         const std::string& topic, bool writes) {
  const auto [first, last] = program.empty()
                                 ? std::pair{ends.begin(), ends.end()}
                                 : ends.equal_range(program);
  return std::any_of(first, last, [&](const auto& x) {
    return x.second->topic == topic && x.second->writes == writes;
  });
}

std::vector<std::string> missing_in(const ends_by_program& ends,
                                    const watch_endpoints& request) {
  std::vector<std::string> result;
  for (const auto& topic : request.written)
    if (!has(ends, request.program, topic, true))
      result.push_back("a writer of " + topic);
  for (const auto& topic : request.read)
    if (!has(ends, request.program, topic, false))
      result.push_back("a reader of " + topic);
  return result;
}

void look(graph_watch_self self, watched_program& x,
          const ends_by_program& ends) {
  auto missing = missing_in(ends, x.request);
  if (x.missing == missing)
    return;
  x.missing = missing;
  self->send(x.listener,
             endpoints_missing{x.request.instance, std::move(missing)});
}

void watch(graph_watch_self self, const watch_endpoints& request) {
  auto& st = self->state;
  auto listener =
      caf::actor_cast<endpoint_listener_actor>(self->current_sender());
  if (!listener)
    return;
  auto& x = st.programs[request.instance];
  // Whoever is started again asks again.
  if (x.listener != listener)
    watch_until_its_end(self, listener);
  x = {request, listener, std::nullopt};
  const auto ends = st.graph->endpoints();
  if (st.graph->is_served())
    look(self, x, sorted(ends));
}

void check_all(graph_watch_self self) {
  auto& st = self->state;
  // Nobody is told again before somebody looks.
  if (st.programs.empty())
    return;
  const auto ends = st.graph->endpoints();
  if (!st.graph->is_served())
    return;
  const auto known = sorted(ends);
  for (auto& [instance, x] : st.programs)
    look(self, x, known);
}

void forget(graph_watch_self self, const caf::actor_addr& gone) {
  auto& programs = self->state.programs;
  for (auto i = programs.begin(); i != programs.end();)
    i = i->second.listener.address() == gone ? programs.erase(i) : std::next(i);
}

} // namespace

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
      [self](const watch_endpoints& request) { watch(self, request); },
      [self](const graph_changed&) { check_all(self); },
  };
}

} // namespace roscell
