#include "tools/roscell/daemon/node_settings.hpp"

#include "actors/core/actor_context.hpp"
#include "actors/node/config_checks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "messages/messages.hpp"
#include "tools/roscell/exit_code.hpp"

#include <caf/send.hpp>
#include <spdlog/spdlog.h>

#include <utility>

namespace roscell::cli {

node_settings::node_settings(const node_source& source, node_reading started)
    : source_{source}, options_{std::move(started.options)},
      config_{to_config(options_)}, in_use_{std::move(started.given)} {}

void node_settings::keep_identity(const std::string& name) {
  config_.new_identity = false;
  config_.name = name;
}

void node_settings::read_again(const running_node& node) {
  const actor_context context{nullptr, node.events};
  const auto refuse = [&](const std::string& reason, const std::string& hint) {
    context.publish_event(events::configuration_refused, node.name,
                          {{"reason", reason}, {"hint", hint}});
  };
  try {
    const auto now = source_.read();
    auto config = to_config(now.options);
    config.name = config_.name;
    if (config.cell.empty())
      config.cell = config.name;
    if (const auto why = check_words(config)) {
      const auto problem = to_failure(why);
      return refuse(problem.message, problem.hint);
    }
    take(now, node);
  } catch (const command_error& why) {
    refuse(why.what(), why.hint);
  }
}

void node_settings::take(const node_reading& now, const running_node& node) {
  const auto changes = option_changes_between(in_use_, now.given);
  const auto config = to_config(now.options);
  config_.skill_dirs = config.skill_dirs;
  config_.labels = config.labels;
  config_.devices = config.devices;
  config_.cpu_floor = config.cpu_floor;
  options_.drain_timeout = now.options.drain_timeout;
  options_.log_level = now.options.log_level;
  spdlog::set_level(spdlog::level::from_str(options_.log_level));
  in_use_ = in_use_after(in_use_, now.given);
  pass_on(node);
  const actor_context context{nullptr, node.events};
  context.publish_event(
      events::configuration_read, node.name,
      {{"changed", changes.changed}, {"needs_restart", changes.needs_restart}});
}

void node_settings::pass_on(const running_node& node) const {
  use_settings result;
  for (const auto& x : config_.skill_dirs)
    result.skill_dirs.push_back(x.string());
  result.labels = config_.labels;
  result.devices = config_.devices;
  result.cpu_floor = config_.cpu_floor;
  caf::anon_send(node.actor, std::move(result));
}

} // namespace roscell::cli
