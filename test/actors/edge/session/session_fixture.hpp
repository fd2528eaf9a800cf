#pragma once

#include "actors/edge/session/session_link.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace roscell::test::wire {

inline const acceptor_identity base_node{"base", "ffff", "kitchen", 3};
inline const joiner_identity robot_node{"robot-1", "0a1b", 7};
inline constexpr const char* site_token = "site-token";

/// What one end of a session got.
struct session_ear {
  session_callbacks callbacks();

  inbox<std::string> frames;
  inbox<std::function<void()>> undone;
  inbox<session_end> ends;
  /// Keeps what `on_frame` gives to call when a frame is done.
  std::atomic<bool> keep_undone{false};
};

/// A server that takes sessions.
struct acceptor_fixture {
  explicit acceptor_fixture(session_options options = {},
                            std::string token = site_token,
                            http_limits limits = {},
                            std::string address = "127.0.0.1");

  session_target target() const {
    return {address, server->port(), {}};
  }

  /// The outcome of one attempt to join.
  session_result join(session_options options = {},
                      std::string token = site_token,
                      joiner_identity identity = robot_node);

  std::string address;
  inbox<std::string> log;
  inbox<established_session> sessions;
  inbox<edge_error> refusals;
  io_thread io{[this](const std::string& line) { log.put(line); }};
  std::unique_ptr<http_server> server;
};

/// Both ends of a session.
struct session_pair : acceptor_fixture {
  explicit session_pair(session_options options = {}, bool started = true)
      : session_pair(options, started, options) {
    // nop
  }

  session_pair(session_options of_acceptor, bool started,
               session_options of_joiner);

  ~session_pair() {
    io.stop();
  }

  void start();

  session_ear at_joiner;
  session_ear at_acceptor;
  established_session joiner;
  established_session acceptor;
};

} // namespace roscell::test::wire
