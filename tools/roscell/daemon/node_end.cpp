#include "tools/roscell/daemon/node_end.hpp"

#include "actors/node/limits.hpp"
#include "tools/roscell/daemon/drain_first.hpp"
#include "tools/roscell/view/format.hpp"

#include <caf/send.hpp>

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace roscell::cli {

namespace {

using stop_clock = std::chrono::steady_clock;

std::string names_of(const std::vector<actor_row>& rows) {
  std::string result;
  for (const auto& x : rows)
    result += (result.empty() ? "" : ", ") + x.name;
  return result;
}

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

void await_end(caf::actor_system& system, const running_node& node,
               stop_signals& signals, exit_code code) {
  const auto deadline = stop_clock::now() + limits::membership::stopping;
  if (!ends_in_time(signals, deadline))
    end_by_force(node, code);
  await_rest(system, node, signals, deadline, code);
}

} // namespace

void empty_node(caf::actor_system& system, const running_node& node,
                stop_signals& signals, std::chrono::milliseconds limit) {
  // What comes too late must not end another wait.
  const auto wanted = std::make_shared<std::atomic<bool>>(true);
  spdlog::info("node '{}' is drained before it stops", node.name);
  drain_first(system, node, [wanted, &signals](const std::string& problem) {
    if (!wanted->exchange(false))
      return;
    if (!problem.empty())
      spdlog::warn("it cannot be drained: {}", printable(problem));
    signals.end();
  });
  const auto end = signals.wait_for(limit);
  if (wanted->exchange(false) && end != stop_signals::cause::ended)
    spdlog::warn("what is left on node '{}' goes on running", node.name);
  undrain(system, node);
}

void stop_in_order(caf::actor_system& system, const running_node& node,
                   stop_signals& signals) {
  spdlog::info("node '{}' stops", node.name);
  caf::anon_send(node.actor, stop_node{});
  await_end(system, node, signals, exit_done);
}

void halt(caf::actor_system& system, const running_node& node,
          stop_signals& signals, exit_code code) {
  caf::anon_send_exit(node.actor, caf::exit_reason::user_shutdown);
  await_end(system, node, signals, code);
}

void await_failed(caf::actor_system& system, const running_node& node,
                  stop_signals& signals) {
  spdlog::error("node '{}' has failed", node.name);
  await_rest(system, node, signals,
             stop_clock::now() + limits::membership::stopping, exit_refused);
}

} // namespace roscell::cli
