#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include "test/parameters_of.hpp"
#include "test/skills/files.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

/// What stands around a skill or its parts in a test. Every wait is for an
/// event, and ends with a failure after `patience`.
namespace roscell::test {

/// Keeps all frames that are pushed.
class collecting_sink : public engine::frame_sink {
public:
  bool push(engine::frame input, engine::when_full policy) override;

  /// Waits for frame number `n`, counted from 0.
  std::optional<engine::frame> wait_for(std::size_t n);

  std::vector<engine::when_full> policies();

private:
  std::mutex mutex_;
  std::condition_variable grown_;
  std::vector<engine::frame> frames_;
  std::vector<engine::when_full> policies_;
};

/// An input handler that runs on its thread, as in the engine.
class running_input {
public:
  explicit running_input(std::unique_ptr<engine::input_handler> handler);
  ~running_input();

  collecting_sink& sink() {
    return sink_;
  }

  /// Waits until the handler has returned by itself. Returns "ended", or the
  /// text of its exception.
  std::string wait();

private:
  std::unique_ptr<engine::input_handler> handler_;
  collecting_sink sink_;
  engine::stop_event stop_;
  engine::stop_event ended_;
  std::string outcome_ = "ended";
  std::thread thread_;
};

/// The node's end of NOTIFY_SOCKET.
class notify_receiver {
public:
  /// `name` as in NOTIFY_SOCKET.
  explicit notify_receiver(const std::string& name);

  /// The next datagram.
  std::optional<std::string> receive();

  /// The next datagram, if one is there already.
  std::optional<std::string> receive_now();

  /// Takes datagrams until one holds `part`, which is returned.
  std::optional<std::string> wait_for(const std::string& part);

private:
  engine::unique_fd fd_;
};

} // namespace roscell::test
