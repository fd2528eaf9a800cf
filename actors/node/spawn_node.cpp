#include "actors/node/spawn_node.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/node/config_checks.hpp"
#include "actors/node/event_log.hpp"
#include "actors/node/node_builder.hpp"
#include "actors/node/node_history.hpp"
#include "actors/node/node_runtime.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/actor_system_config.hpp>

#include <utility>

namespace roscell {

namespace {

/// What an operator should know of the data directory.
void publish_data_state(const actor_context& context, const node_data& data) {
  if (!data.put_aside.empty())
    context.publish_event(events::identity_renewed, data.identity.uuid,
                          {{"put_aside", data.put_aside.filename().string()}});
  for (const auto& x : data.unread)
    context.publish_event(events::record_ignored, x.key,
                          {{"table", x.table}, {"reason", x.why}});
}

/// A step that says "node" by a label means a node's name, mostly.
void publish_label(const actor_context& context, const node_config& config) {
  const auto own = config.labels.find("node");
  if (own != config.labels.end() && own->second != config.name)
    context.publish_event(
        events::name_label_ignored, config.name,
        {{"label", "node=" + own->second},
         {"reason", "the node has a label 'node' of its own, so that a step "
                    "with the label node="
                        + config.name + " does not find it"}});
}

running_node first_events(const node_config& config,
                          const actor_context& context,
                          const node_edges& edges) {
  running_node result;
  result.events = context.events;
  result.actors = context.directory;
  result.name = config.name;
  result.http_address = edges.http_address;
  result.socket = edges.socket_path;
  result.discovery_server = edges.discovery_server;
  return result;
}

} // namespace

caf::expected<running_node> spawn_node(caf::actor_system& system,
                                       const node_config& wanted,
                                       const node_additions& additions) {
  auto config = wanted;
  if (auto why = complete_config(config))
    return why;
  auto bound = parse_capacity(config.capacity);
  if (auto* why = std::get_if<edge_error>(&bound))
    return to_caf(*why);
  auto runtime = choose_runtime(config);
  if (!runtime)
    return runtime.error();
  if (auto why = check_grants(config, *runtime))
    return why;
  config.runtime = runtime->name;
  auto data = open_node_data(config);
  if (!data)
    return data.error();
  auto skills =
      offered_skills(skill_places_of(config), *runtime, additions.actor_skills);
  if (!skills)
    return skills.error();
  actor_context context{std::make_shared<actor_directory>(), {}};
  context.metrics = std::make_shared<metric_table>();
  context.blocking = std::make_shared<blocking_threads>(system);
  const auto past = spawn_blocking(system, context, node_history, data->past);
  context.events = spawn(system, context, event_log,
                         event_log_setup{past, data->past->first_number()});
  auto edges = open_edges(config, *data, context);
  if (!edges) {
    caf::anon_send_exit(context.events, caf::exit_reason::user_shutdown);
    return edges.error();
  }
  publish_data_state(context, *data);
  publish_label(context, config);
  auto result = first_events(config, context, **edges);
  result.token_file = data->token_file;
  result.site_token_file = data->site.file().string();
  result.runtime = runtime->name;
  result.runtime_reason = runtime->reason;
  find_limits(config, data->identity.uuid, *runtime);
  result.limits = runtime->limits;
  node_builder builder{system,
                       std::move(config),
                       std::move(*data),
                       context,
                       past,
                       *edges,
                       std::get<capacity_bound>(bound),
                       *runtime,
                       std::move(*skills),
                       additions};
  builder.build(result);
  return result;
}

} // namespace roscell
