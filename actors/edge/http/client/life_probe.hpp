#pragma once

#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/io/io_core.hpp"

#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <functional>
#include <memory>

namespace roscell {

/// INTERNAL to the edge: asks a server again and again whether it lives, each
/// time on a connection of its own, while somebody waits for it on another one.
/// A process that is stopped keeps its connections, and the kernel goes on to
/// accept new ones, so that only an answer is a proof. Io thread only.
class life_probe : public std::enable_shared_from_this<life_probe> {
public:
  /// @param question asked after each `pause` without a byte.
  /// @param on_silent called when it gets no answer; the last that is done.
  life_probe(std::shared_ptr<io_core> core, http_call question,
             std::chrono::milliseconds pause, std::function<void()> on_silent);

  /// Waits for the first pause; while one is waited for, begins it anew.
  void wait();

private:
  void ask();
  void on_answer(const http_outcome& outcome);

  const std::shared_ptr<io_core> core_;
  const http_call question_;
  const std::chrono::milliseconds pause_;
  const std::function<void()> on_silent_;
  boost::asio::steady_timer timer_;
  unsigned waits_ = 0;
};

} // namespace roscell
