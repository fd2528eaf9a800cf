#pragma once

#include "actors/edge/disk/data_folder.hpp"
#include "actors/edge/http/http_server.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "roscell/node_config.hpp"

#include <memory>
#include <string>

namespace roscell::cli {

/// Answers on the Unix socket of a node that cannot be made yet. Whoever asks
/// is refused, and told what the node waits for. Keeps the data directory from
/// other nodes as long as it lives.
class waiting_answers {
public:
  /// Throws command_error where another node has the directory or the socket.
  explicit waiting_answers(const node_config& config);

  /// What is missing, in a sentence without a full stop.
  void set_missing(const std::string& text);

private:
  struct shared_text;

  directory_lock lock_;
  std::shared_ptr<shared_text> missing_;
  io_thread io_;
  std::unique_ptr<http_server> server_;
};

} // namespace roscell::cli
