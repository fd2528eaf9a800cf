#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <filesystem>

namespace roscell {

/// What the shim of a command in a container holds on to. It sees at once that
/// the node has let go of it, or has ended: nobody ever takes its connection.
class lifeline_socket {
public:
  /// Errors: engine_failed.
  static edge_result<lifeline_socket> open(std::filesystem::path path);

  lifeline_socket(lifeline_socket&&) noexcept = default;
  lifeline_socket& operator=(lifeline_socket&&) noexcept = default;
  ~lifeline_socket();

  void cut();

private:
  lifeline_socket(std::filesystem::path path, unique_fd fd)
      : path_(std::move(path)), fd_(std::move(fd)) {
    // nop
  }

  std::filesystem::path path_;
  unique_fd fd_;
};

} // namespace roscell
