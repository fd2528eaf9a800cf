#pragma once

#include "actors/edge/http/handshake_queue.hpp"
#include "actors/edge/http/http_access.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/edge/trust/site_identity.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace roscell {

class http_connection;

/// What a client is told for whom there is no room.
edge_error crowd_error();

/// Whom a connection comes from; each group has its own allowance.
enum class http_group {
  unauthenticated_peers, ///< TCP, no bearer token shown yet.
  joining, ///< TCP, asks for a session, and has proved nothing yet.
  trusted, ///< TCP, showed it.
  local,   ///< The Unix socket.
  refused, ///< There is no room: is being told so.
};

/// INTERNAL to this folder: the connections of one server. Io thread only.
class connection_table {
public:
  explicit connection_table(const http_limits& limits);

  /// Whether one more can be added. Makes room among those who have proved
  /// nothing by closing one.
  bool make_room(http_group group);

  /// Tells the connection that there is no room, unless even those who are told
  /// so are too many: then it is false.
  bool refuse(const std::shared_ptr<http_connection>& connection);

  /// Serves the connection, or a local one when it is its turn.
  void add(const std::shared_ptr<http_connection>& connection,
           http_group group);

  /// Moves an unauthenticated peer to another group; false if there is no room.
  bool promote(const http_connection* connection, http_group group);

  void remove(const http_connection* connection);

  /// Closes the one of a group that was silent for longest, if there is one.
  void evict_from(http_group group);

  std::vector<std::shared_ptr<http_connection>> all() const;

  bool empty() const {
    return entries_.empty();
  }

private:
  struct entry {
    std::shared_ptr<http_connection> connection;
    http_group group;
    bool queued;
  };

  size_t& count(http_group group) {
    return counts_[static_cast<size_t>(group)];
  }

  bool full(http_group group);
  void serve_next();

  std::array<size_t, 5> limits_;
  size_t waiting_limit_;
  std::array<size_t, 5> counts_{};
  /// Local clients that wait for their turn.
  std::deque<const http_connection*> queue_;
  std::unordered_map<const http_connection*, entry> entries_;
};

/// INTERNAL to this folder: what the connections of one server share. All but
/// `core` and `limits` is for the io thread only.
struct http_shared {
  http_shared(std::shared_ptr<io_core> on, const http_limits& bounds)
      : core(std::move(on)), limits(bounds), table(bounds) {
    // nop
  }

  const std::shared_ptr<io_core> core;
  const http_limits limits;
  http_access access;
  http_handler handler;
  std::shared_ptr<site_identity> identity; ///< Null: TCP is plain.
  std::function<void(const std::string&, const distrusted&)> on_distrusted;
  handshake_queue hands{limits::trust::handshakes,
                        limits::trust::handshakes_of_one};
  std::shared_ptr<const session_acceptor> sessions; ///< Null: none are taken.
  size_t open_sessions = 0;
  bool draining = false;         ///< Every reply is the last one.
  std::function<void()> on_idle; ///< Called when the table gets empty.
  connection_table table;
};

/// INTERNAL to this folder: where the answer to the request in progress of a
/// connection goes, from any thread and also after the client has gone.
std::shared_ptr<reply_sink>
make_sink(std::shared_ptr<http_shared> shared,
          std::weak_ptr<http_connection> connection);

/// Status line and header fields of a reply that is not a stream.
/// @param more further lines, each after its line break.
std::string reply_head(const http_reply& reply, bool is_last,
                       const std::string& more = {});

/// INTERNAL to this folder: takes connections from one listening socket.
/// Io thread only.
class http_listener : public std::enable_shared_from_this<http_listener> {
public:
  /// Owns `fd`, which does not block. `local` says that it is a Unix socket.
  http_listener(std::shared_ptr<http_shared> shared, int fd, bool local);

  void run();
  void close();

private:
  using error = boost::system::error_code;

  void wait();
  bool accept_one();
  void admit(int fd);
  void rest();

  std::shared_ptr<http_shared> shared_;
  boost::asio::posix::stream_descriptor listening_;
  boost::asio::steady_timer pause_;
  const bool local_;
  bool complained_ = false;
};

} // namespace roscell
