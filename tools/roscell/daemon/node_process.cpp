#include "tools/roscell/daemon/node_process.hpp"

#include "actors/core/actor_context.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/session/site_token.hpp"
#include "actors/node/event_series.hpp"
#include "actors/site/node_identity.hpp"
#include "messages/event_kinds.hpp"
#include "messages/messages.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/daemon/node_address.hpp"
#include "tools/roscell/daemon/node_end.hpp"
#include "tools/roscell/daemon/waiting_answers.hpp"
#include "tools/roscell/dashboard/pages.hpp"
#include "tools/roscell/doctor/check.hpp"
#include "tools/roscell/doctor/host/rights.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <caf/actor_system_config.hpp>
#include <caf/scheduler/abstract_coordinator.hpp>
#include <caf/send.hpp>
#include <caf/typed_event_based_actor.hpp>
#include <spdlog/spdlog.h>

#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <utility>

namespace roscell::cli {

namespace {

class node_system_config : public caf::actor_system_config {
public:
  node_system_config() {
    // The default policy polls; this one sleeps until there is work.
    set("scheduler.policy", caf::atom("sharing"));
    set("scheduler.max-threads", size_t{2});
    set("logger.verbosity", caf::atom("quiet"));
  }
};

/// No actor of a node prints: who throws ends with what it has thrown
/// (`end_by_exception`). So nobody needs the thread that CAF has for printing.
void end_printing(caf::actor_system& system) {
  caf::anon_send_exit(system.scheduler().printer(),
                      caf::exit_reason::user_shutdown);
}

/// What the failure of a start means to whoever called us.
exit_code exit_code_of(error_code code) {
  return code == error_code::schema_violation ? exit_usage
         : code == error_code::unreachable    ? exit_unreachable
                                              : exit_refused;
}

void introduce_site_token(const std::string& file) {
  if (::access(file.c_str(), F_OK) == 0)
    spdlog::info("site token {}", printable(file));
  else
    spdlog::info("no site token yet, so no cell takes this node: {}",
                 printable(site_token_hint(file)));
  if (const auto warning = open_secret_warning(file); !warning.empty())
    spdlog::warn("{}", printable(warning));
}

void introduce(const running_node& node, const node_config& config) {
  spdlog::info("node '{}' listens on {} and {}", node.name, node.http_address,
               node.socket);
  if (config.coordinator)
    spdlog::info("cell '{}' has its discovery server on {}",
                 config.cell.empty() ? node.name : config.cell,
                 node.discovery_server);
  spdlog::info("instances are run by '{}': {}", node.runtime,
               node.runtime_reason);
  spdlog::info("limits of instances: {}", printable(node.limits));
  spdlog::info("data directory {}, bearer token {}", config.data_dir.string(),
               node.token_file);
  if (has_identity_file(config))
    spdlog::info("identity {}", printable(identity_file_of(config).string()));
  else
    introduce_site_token(node.site_token_file);
  if (const auto warning = root_warning(::geteuid(), is_kept_root());
      !warning.empty())
    spdlog::warn("{}", warning);
  if (config.ros2_set_parameters)
    spdlog::warn("whoever is in the network of this cell may set parameters of "
                 "its running skills: --ros2-set-parameters");
  for (const auto& x : find_open_skills(config))
    spdlog::warn("{}; {}", printable(x.what), printable(x.remedy));
}

std::string text_of_change(const interface_address& at,
                           const std::string& successor) {
  if (!at.carrier)
    return "interface '" + at.name + "' has a carrier now";
  if (successor == at.address)
    return "its address " + successor + " was gone, and is back";
  return "the address of interface '" + at.name + "' has changed from "
         + at.address + " to " + successor;
}

void print_address_change(const running_node& node, const interface_address& at,
                          const std::string& former) {
  const actor_context context{nullptr, node.events};
  if (former.empty())
    return;
  if (former == at.address)
    context.publish_event(events::address_returned, node.name,
                          {{"address", at.address}});
  else
    context.publish_event(
        events::address_changed, node.name,
        {{"interface", at.name}, {"from", former}, {"to", at.address}});
}

} // namespace

node_process::node_process(const node_source& source, node_reading started,
                           std::string interface)
    : settings_{source, std::move(started)}, interface_(std::move(interface)),
      fixed_(is_ipv4_address(interface_)),
      starter_(settings_.options().ready_fd), signals_{hangups::heard} {}

exit_code node_process::run() {
  node_system_config system_config;
  caf::actor_system system{system_config};
  end_printing(system);
  std::string former;
  for (;;) {
    const auto at = await_address();
    if (!at)
      return exit_done;
    const auto node = start(system, *at);
    if (!node)
      continue;
    introduce(*node, settings_.config());
    start_journal(system, node->events);
    print_address_change(*node, *at, former);
    // The start needed memory that running does not.
    malloc_trim(0);
    starter_.ready();
    const auto end = serve(*node, *at);
    if (end != node_end::renewal && end != node_end::identity)
      return finish(system, *node, end);
    halt(system, *node, signals_, exit_refused);
    former = end == node_end::renewal ? at->address : std::string{};
  }
}

/// Fast DDS makes no discovery server where there is no carrier, and a
/// coordinator is nothing without its own. A member looks after its instances
/// meanwhile, and is made anew when the carrier comes.
std::variant<interface_address, std::string> node_process::look() const {
  return find_interface(interface_, settings_.config().coordinator,
                        list_interfaces(), list_links());
}

/// Where the node can be made; none where it is to end before. What it lacks
/// is told once, and again when that changes; whoever asks is told, too.
std::optional<interface_address> node_process::await_address() {
  std::optional<waiting_answers> answers;
  std::string lacking;
  for (;;) {
    const auto found = look();
    if (const auto* at = std::get_if<interface_address>(&found))
      return *at;
    if (!answers)
      answers.emplace(settings_.config());
    const auto& missing = std::get<std::string>(found);
    const auto text = missing + "; this host has: "
                      + describe_links(list_interfaces(), list_links());
    answers->set_missing(text);
    if (std::exchange(lacking, missing) != missing) {
      spdlog::warn("the node waits for its interface: {}", printable(text));
      starter_.waiting("waits for its interface: " + text);
    }
    const auto cause = signals_.wait_with(watch_.fd(), std::nullopt);
    hung_up_ = hung_up_ || cause == stop_signals::cause::hangup;
    if (cause == stop_signals::cause::news)
      watch_.clear();
    else if (cause != stop_signals::cause::hangup)
      return std::nullopt;
  }
}

/// None where the address has gone meanwhile.
std::optional<running_node> node_process::start(caf::actor_system& system,
                                                const interface_address& at) {
  auto config = settings_.config();
  config.address = at.address;
  node_additions additions;
  additions.check_host = [config] { return check_own_host(config); };
  additions.start_anew = [this] { signals_.renew(); };
  config.pages = dashboard_pages();
  auto node = spawn_node(system, config, additions);
  if (node) {
    settings_.keep_identity(node->name);
    node->actor->attach_functor([this] { signals_.end(); });
    return std::move(*node);
  }
  const auto found = look();
  const auto* now = std::get_if<interface_address>(&found);
  if (!fixed_ && (!now || now->address != at.address))
    return std::nullopt;
  const auto why = to_failure(node.error());
  throw command_error{exit_code_of(why.code), why.message, why.hint};
}

/// Until the node is to end, or has ended.
node_process::node_end node_process::serve(const running_node& node,
                                           const interface_address& at) {
  using clock = std::chrono::steady_clock;
  address_tracker tracker{at, fixed_};
  tracker.observe(list_interfaces(), clock::now());
  if (std::exchange(hung_up_, false))
    settings_.read_again(node);
  for (;;) {
    switch (signals_.wait_with(watch_.fd(), tracker.due())) {
    case stop_signals::cause::signal:
      return node_end::signal;
    case stop_signals::cause::ended:
      return node_end::failure;
    case stop_signals::cause::news:
      watch_.clear();
      tracker.observe(list_interfaces(), clock::now());
      break;
    case stop_signals::cause::hangup:
      settings_.read_again(node);
      break;
    case stop_signals::cause::renewal:
      spdlog::warn("node '{}' is made anew: it has an identity of another site "
                   "than before",
                   node.name);
      return node_end::identity;
    case stop_signals::cause::timeout:
      break;
    }
    switch (tracker.action(clock::now())) {
    case address_action::stay:
      break;
    case address_action::renew:
      spdlog::warn("node '{}' is made anew: {}", node.name,
                   text_of_change(at, tracker.successor()));
      return node_end::renewal;
    case address_action::give_up:
      spdlog::error("address {} is not of this host any more", at.address);
      return node_end::address_gone;
    }
  }
}

exit_code node_process::finish(caf::actor_system& system,
                               const running_node& node, node_end end) {
  if (end == node_end::failure) {
    await_failed(system, node, signals_);
    return exit_refused;
  }
  starter_.stopping();
  if (end == node_end::address_gone) {
    halt(system, node, signals_, exit_unreachable);
    return exit_unreachable;
  }
  if (const auto& limit = settings_.options().drain_timeout; limit != "0")
    empty_node(system, node, signals_, parse_duration(limit));
  stop_in_order(system, node, signals_);
  return exit_done;
}

namespace {

std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

std::string hint_of(const event& e) {
  const auto hint = event_text(e, "hint");
  return hint.empty() ? hint : " (" + hint + ")";
}

std::string list_in(const event& e, const char* key) {
  std::string result;
  const auto data = json::parse(e.data, nullptr, false);
  if (data.is_object() && data.contains(key) && data[key].is_array())
    for (const auto& x : data[key])
      if (x.is_string())
        result += (result.empty() ? "" : ", ") + x.get<std::string>();
  return result;
}

std::string reading_line(const event& e) {
  const auto changed = list_in(e, "changed");
  const auto restart = list_in(e, "needs_restart");
  return "read its configuration and its skills anew; "
         + (changed.empty() ? "no option has changed" : "changed: " + changed)
         + (restart.empty() ? "" : "; needs a restart: " + restart);
}

void print(const event& e) {
  static constexpr spdlog::level::level_enum levels[] = {
      spdlog::level::debug, spdlog::level::info, spdlog::level::warn};
  spdlog::log(levels[static_cast<size_t>(loudness_of(e))], "{}",
              journal_line(e));
}

event_listener_actor::behavior_type journal(event_listener_actor::pointer self,
                                            const event_log_actor& events) {
  watch_until_own_end(self, events);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  // A program that crashes again and again would fill the system's log.
  return {[](const event& e) {
    if (!e.passing)
      print(e);
  }};
}

} // namespace

void start_journal(caf::actor_system& system, const event_log_actor& events) {
  const auto listener = system.spawn(journal, events);
  caf::anon_send(events, subscribe_events{listener, 0});
}

std::string journal_line(const event& e) {
  const auto text = [&](const char* key) { return event_text(e, key); };
  std::string line;
  if (e.what == events::cell_joined)
    line = "joined cell " + quoted(text("cell")) + " of "
           + quoted(text("coordinator"));
  else if (e.what == events::cell_left)
    line = "left cell " + quoted(text("cell"));
  else if (e.what == events::coordinator_lost)
    line = "lost cell " + quoted(text("cell")) + ": " + text("reason");
  else if (e.what == events::join_refused)
    line = "cannot join at " + text("discovery_server") + ": " + text("reason")
           + hint_of(e);
  else if (e.what == events::join_failed)
    line = (text("discovery_server").empty()
                ? "in no cell yet: "
                : "not joined yet at " + text("discovery_server") + ": ")
           + text("reason") + hint_of(e);
  else if (e.what == events::configuration_read)
    line = reading_line(e);
  else
    line = e.what + " " + quoted(e.subject) + " " + event_particulars(e);
  line = printable(line);
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

} // namespace roscell::cli
