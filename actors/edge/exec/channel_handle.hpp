#pragma once

#include "actors/edge/exec/exec_channel.hpp"
#include "actors/edge/io/io_core.hpp"

#include <memory>
#include <string>
#include <utility>

/// INTERNAL to this folder: what runs on the io thread behind a channel, and
/// what its owner holds.
namespace roscell {

/// Io thread only.
class channel_core : public exec_channel, public io_component {
public:
  virtual void run() = 0;

  /// Ends the command, and calls nothing any more.
  virtual void abandon() = 0;
};

/// Passes everything on to the io thread.
class channel_handle final : public exec_channel {
public:
  channel_handle(std::shared_ptr<io_core> core,
                 std::shared_ptr<channel_core> channel)
      : core_(std::move(core)), channel_(std::move(channel)) {
    core_->post([channel = channel_] { channel->run(); });
  }

  channel_handle(const channel_handle&) = delete;
  channel_handle& operator=(const channel_handle&) = delete;

  ~channel_handle() override {
    core_->post([channel = channel_] { channel->abandon(); });
  }

  void write(std::string bytes, bool last) override {
    core_->post([channel = channel_, bytes = std::move(bytes), last]() mutable {
      channel->write(std::move(bytes), last);
    });
  }

  void resize(terminal_size size) override {
    core_->post([channel = channel_, size] { channel->resize(size); });
  }

  void read_on(bool of_errors) override {
    core_->post(
        [channel = channel_, of_errors] { channel->read_on(of_errors); });
  }

  void end(std::string reason) override {
    core_->post([channel = channel_, reason = std::move(reason)] {
      channel->end(reason);
    });
  }

private:
  std::shared_ptr<io_core> core_;
  std::shared_ptr<channel_core> channel_;
};

inline std::shared_ptr<exec_channel>
handle_of(std::shared_ptr<io_core> core,
          std::shared_ptr<channel_core> channel) {
  return std::make_shared<channel_handle>(std::move(core), std::move(channel));
}

} // namespace roscell
