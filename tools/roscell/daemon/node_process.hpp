#pragma once

#include "actors/edge/host/interfaces.hpp"
#include "actors/node/spawn_node.hpp"
#include "messages/inside/introspection.hpp"
#include "tools/roscell/config/node_source.hpp"
#include "tools/roscell/daemon/node_address.hpp"
#include "tools/roscell/daemon/node_settings.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/service_signals.hpp"

#include <caf/actor_system.hpp>

#include <optional>
#include <string>
#include <variant>

namespace roscell::cli {

/// The nodes that this process makes one after another: a new one, with the
/// same UUID, instances and socket, whenever the address of its interface has
/// changed. To be made before other threads, which inherit the signals that it
/// blocks.
class node_process {
public:
  /// `interface` is a name or an address.
  node_process(const node_source& source, node_reading started,
               std::string interface);

  /// Until SIGINT or SIGTERM; SIGHUP has its options read again. Throws
  /// command_error when no node can be made.
  exit_code run();

private:
  /// Why a node has come to an end.
  enum class node_end { signal, failure, renewal, identity, address_gone };

  std::variant<interface_address, std::string> look() const;
  std::optional<interface_address> await_address();
  std::optional<running_node> start(caf::actor_system& system,
                                    const interface_address& at);
  node_end serve(const running_node& node, const interface_address& at);
  exit_code finish(caf::actor_system& system, const running_node& node,
                   node_end end);

  node_settings settings_;
  std::string interface_;
  bool fixed_; ///< It is an address.
  readiness starter_;
  stop_signals signals_;
  address_watch watch_;
  bool hung_up_ = false; ///< While no node could be told.
};

/// Writes the events of a node to the log of this process, for people who read
/// it or the service manager's journal: what concerns the cell in sentences,
/// losses and failures as warnings. Ends with `events`.
void start_journal(caf::actor_system& system, const event_log_actor& events);

/// An event in one line: "joined cell 'lab' of 'arm-1'".
std::string journal_line(const event& e);

} // namespace roscell::cli
