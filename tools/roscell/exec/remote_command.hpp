#pragma once

#include "actors/edge/exec/exec_channel.hpp"
#include "messages/exec.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace roscell::cli {

/// A command that runs beside an instance, asked of any node of the cell. May
/// be used by several threads, but input is given by one only. Every function
/// throws as `node_client` does.
class remote_command {
public:
  /// Begins it.
  remote_command(const node_client& node, const exec_request& what);

  /// Gives it input, and waits until it is taken.
  void give(std::string_view bytes, bool last);

  void resize(terminal_size size) const;

  /// Ends it, as far as its node can be asked.
  void hang_up() const noexcept;

  /// The next output, or the end. Waits some seconds at most.
  exec_output more();

  /// Nobody has time for output now, but it is wanted.
  void stay() const;

private:
  exec_output ask(int64_t wait_ms) const;
  exec_input input() const;

  const node_client& node_;
  std::string node_name_;
  std::string session_;
  int64_t given_ = 0;
  int64_t seen_ = 0;
};

} // namespace roscell::cli
