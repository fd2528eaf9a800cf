#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/host/host_probe_capacity.hpp"
#include "actors/instances/secrets/secret_names.hpp"
#include "actors/instances/skills/skill_catalogue.hpp"
#include "actors/membership/membership.hpp"
#include "actors/node/node.hpp"
#include "actors/node/node_data.hpp"
#include "actors/node/node_edges.hpp"
#include "actors/node/node_runtime.hpp"
#include "actors/node/spawn_node.hpp"
#include "actors/placement/searcher.hpp"

#include <caf/actor_cast.hpp>
#include <caf/actor_system.hpp>

#include <functional>
#include <memory>
#include <utility>

namespace roscell {

/// Starts the actors of a node, those first that others need.
class node_builder {
public:
  node_builder(caf::actor_system& system, node_config config, node_data data,
               actor_context context, node_history_actor history,
               std::shared_ptr<node_edges> edges, capacity_bound bound,
               chosen_runtime runtime, shared_skill_catalogue catalogue,
               node_additions additions);
  void build(running_node& result);

private:
  template <class Handle>
  Handle add(Handle child) {
    parts_.children.push_back(caf::actor_cast<caf::actor>(child));
    return child;
  }

  template <class Function, class... Args>
  auto start(Function function, Args&&... args) {
    return add(
        spawn(system_, parts_.context, function, std::forward<Args>(args)...));
  }

  template <class Function, class... Args>
  auto start_blocking(Function function, Args&&... args) {
    return add(spawn_blocking(system_, parts_.context, function,
                              std::forward<Args>(args)...));
  }

  std::function<runtime_actor(container_listener_actor)> make_runtime();
  void start_images();
  void start_secrets();
  void start_site();
  void start_supervision();
  void start_coordination();
  scheduler_actor start_scheduler(std::shared_ptr<search_guard> guard);
  discovery_actor start_discovery();
  session_connector_actor start_connector();
  membership_config membership_setup() const;
  void start_membership();
  void start_watching();
  void start_builds();
  void start_measuring();
  void start_prober();
  void start_execs();
  void start_requests();

  /// A primary node knows too little to show it.
  std::shared_ptr<const web_pages> pages() const;

  caf::actor_system& system_;
  node_data data_;
  node_history_actor history_;
  capacity_bound bound_;
  chosen_runtime runtime_;
  node_parts parts_;
  node_additions additions_;
  state_store_actor store_;
  build_fetcher_actor fetcher_;
  image_exchange_actor images_; ///< Invalid: there is no engine.
  shared_secret_names secret_names_ = std::make_shared<secret_names>();
};

} // namespace roscell
