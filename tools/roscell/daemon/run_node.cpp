#include "actors/edge/dds/discovery_setup.hpp"
#include "actors/edge/host/descriptor_limit.hpp"
#include "actors/house/limits.hpp"
#include "actors/node/node_builder.hpp"
#include "tools/roscell/client/open_secret.hpp"
#include "tools/roscell/daemon/drain_first.hpp"
#include "tools/roscell/daemon/interface_choice.hpp"
#include "tools/roscell/daemon/journal.hpp"
#include "tools/roscell/daemon/node_options.hpp"
#include "tools/roscell/daemon/readiness.hpp"
#include "tools/roscell/daemon/stop_signals.hpp"
#include "tools/roscell/dashboard/pages.hpp"
#include "tools/roscell/doctor/checks.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <caf/actor_system.hpp>
#include <caf/actor_system_config.hpp>
#include <caf/send.hpp>

#include <malloc.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include <unistd.h>

namespace roscell::cli {

namespace {

class node_system_config : public caf::actor_system_config {
public:
  node_system_config() {
    roscell::add_message_types(*this);
    // The default policy polls; this one sleeps until there is work.
    set("scheduler.policy", caf::atom("sharing"));
    set("scheduler.max-threads", size_t{2});
    set("logger.verbosity", caf::atom("quiet"));
  }
};

/// Small memory counts more than fast allocation on a robot: threads share
/// one arena, and freed memory goes back to the system early.
void save_memory() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TRIM_THRESHOLD, 64 * 1024);
  mallopt(M_MMAP_THRESHOLD, 64 * 1024);
}

void set_up_log(const node_options& options) {
  auto log = spdlog::stderr_logger_mt("roscell");
  log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  log->set_level(spdlog::level::from_str(options.log_level));
  log->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(log);
}

/// What the failure of a start means to whoever called us.
exit_code exit_code_of(error_code code) {
  return code == error_code::schema_violation ? exit_usage
         : code == error_code::unreachable    ? exit_unreachable
                                              : exit_refused;
}

running_node start(caf::actor_system& system, node_config config) {
  node_additions additions;
  additions.examine_host = [config] { return examine_own_host(config); };
  config.pages = dashboard_pages();
  auto node = spawn_node(system, config, additions);
  if (node)
    return std::move(*node);
  const auto why = to_failure(node.error());
  throw command_error{exit_code_of(why.code), why.message, why.hint};
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
  spdlog::info("data directory {}, bearer token {}", config.data_dir.string(),
               node.token_file);
  if (config.site_token_file.empty())
    spdlog::info("no site token: only nodes of this machine can be members");
  else if (const auto warning = open_secret_warning(config.site_token_file);
           !warning.empty())
    spdlog::warn("{}", printable(warning));
}

using stop_clock = std::chrono::steady_clock;

std::string names_of(const std::vector<actor_row>& rows) {
  std::string result;
  for (const auto& x : rows)
    result += (result.empty() ? "" : ", ") + x.name;
  return result;
}

/// Ends the process although parts of it have not ended: threads that hang must
/// not keep it.
[[noreturn]] void end_by_force(const running_node& node, exit_code code) {
  spdlog::warn("node '{}' is ended before it has stopped in order: {}",
               node.name, names_of(node.actors->rows()));
  _exit(code);
}

/// True if what is waited for ends in time, and no other signal comes.
bool ends_in_time(stop_signals& signals, stop_clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
      deadline - stop_clock::now());
  return signals.wait_for(std::max(left, std::chrono::milliseconds{0}))
         == stop_signals::cause::ended;
}

/// The node has ended; what it leaves behind, such as the answer to a request,
/// gets the rest of the time.
void await_rest(caf::actor_system& system, const running_node& node,
                stop_signals& signals, stop_clock::time_point deadline,
                exit_code code) {
  std::thread rest{[&] {
    system.await_all_actors_done();
    signals.end();
  }};
  if (!ends_in_time(signals, deadline))
    end_by_force(node, code);
  rest.join();
}

/// Gives away what runs here, for as long as it was told to try that, and not
/// after another signal. What is left goes on running.
void empty_node(caf::actor_system& system, const running_node& node,
                stop_signals& signals, std::chrono::milliseconds limit) {
  // What comes too late must not end another wait.
  const auto wanted = std::make_shared<std::atomic<bool>>(true);
  spdlog::info("node '{}' is drained before it stops", node.name);
  drain_first(system, node, [wanted, &signals](const std::string& trouble) {
    if (!wanted->exchange(false))
      return;
    if (!trouble.empty())
      spdlog::warn("it cannot be drained: {}", printable(trouble));
    signals.end();
  });
  const auto end = signals.wait_for(limit);
  if (wanted->exchange(false) && end != stop_signals::cause::ended)
    spdlog::warn("what is left on node '{}' goes on running", node.name);
  undrain(system, node);
}

/// Waits until the node has stopped, but not for long, and not at all after
/// another signal.
void stop(caf::actor_system& system, const running_node& node,
          stop_signals& signals) {
  const auto deadline = stop_clock::now() + limits::membership::stopping;
  spdlog::info("node '{}' stops", node.name);
  caf::anon_send(node.actor, stop_node{});
  if (!ends_in_time(signals, deadline))
    end_by_force(node, exit_done);
  await_rest(system, node, signals, deadline, exit_done);
}

} // namespace

int run_node(const node_options& options) {
  prepare_dds_environment();
  save_memory();
  raise_descriptor_limit();
  std::signal(SIGPIPE, SIG_IGN);
  readiness starter{options.ready_fd};
  auto config = to_config(options);
  config.address = choose_interface(options.interface).address;
  // Threads inherit what is blocked here, so it comes before all of them.
  stop_signals signals;
  set_up_log(options);
  node_system_config system_config;
  caf::actor_system system{system_config};
  const auto node = start(system, config);
  node.actor->attach_functor([&signals] { signals.end(); });
  introduce(node, config);
  start_journal(system, node.events);
  // The start needed memory that running does not.
  malloc_trim(0);
  starter.ready();
  if (signals.wait() == stop_signals::cause::ended) {
    spdlog::error("node '{}' has failed", node.name);
    await_rest(system, node, signals,
               stop_clock::now() + limits::membership::stopping, exit_refused);
    return exit_refused;
  }
  starter.stopping();
  if (options.drain_timeout != "0")
    empty_node(system, node, signals, parse_duration(options.drain_timeout));
  stop(system, node, signals);
  return exit_done;
}

} // namespace roscell::cli
