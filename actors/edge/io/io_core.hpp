#pragma once

#include "actors/edge/io/io_thread.hpp"

#include <boost/asio/io_context.hpp>

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

namespace roscell {

/// Something that lives on the io thread until it is closed.
class io_component {
public:
  virtual ~io_component() = default;

  /// Closes sockets and calls closing callbacks, synchronously: nothing that
  /// is posted runs any more.
  virtual void on_io_stop() = 0;
};

/// INTERNAL to this folder: the event loop behind an io_thread. It is shared
/// by everything that holds one of its sockets, so that no socket outlives
/// its loop.
class io_core {
public:
  explicit io_core(edge_log log);

  io_core(const io_core&) = delete;
  io_core& operator=(const io_core&) = delete;

  boost::asio::io_context& context() {
    return context_;
  }

  /// From any thread; ignored once `stop` was called.
  void post(std::function<void()> task);

  /// Keeps `component` alive until it is released or the loop stops.
  /// Io thread only, as are `release` and `guarded`.
  void adopt(std::shared_ptr<io_component> component);
  void release(const io_component* component);

  /// Runs a callback of the user, whose exceptions are logged.
  template <class Callback>
  void guarded(Callback&& callback) {
    try {
      callback();
    } catch (const std::exception& error) {
      log(std::string{"a callback threw: "} + error.what());
    } catch (...) {
      log("a callback threw something that is no exception");
    }
  }

  void log(const std::string& sentence);

  /// The body of the thread.
  void run();

  /// From any thread: lets `run` return soon.
  void stop();

private:
  /// Opens the door to a protected member of Asio: it destroys the handlers
  /// that wait in the loop, whose captures may hold this object.
  struct loop : boost::asio::io_context {
    using boost::asio::io_context::io_context;
    using boost::asio::io_context::shutdown;
  };

  void close_components();

  edge_log log_;
  /// The hint that only one thread runs it would let tasks of other threads
  /// overtake those that this thread has posted to itself.
  loop context_;
  std::mutex mutex_;
  bool stopping_ = false;
  std::unordered_map<const io_component*, std::shared_ptr<io_component>>
      components_;
};

} // namespace roscell
