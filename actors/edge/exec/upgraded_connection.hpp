#pragma once

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// INTERNAL to this folder: a connection to an engine that begins with a
/// request and an answer by HTTP, and goes on with the bytes of a command, both
/// ways. Io thread only.
class upgraded_connection
    : public std::enable_shared_from_this<upgraded_connection> {
public:
  struct callbacks {
    /// The engine has agreed.
    std::function<void()> on_open;
    /// The next bytes come after `read`.
    std::function<void(std::string_view)> on_bytes;
    /// It has ended; the status and the text of the engine where it has not
    /// agreed, else 0.
    std::function<void(int status, std::string text)> on_end;
  };

  upgraded_connection(std::shared_ptr<io_core> core, callbacks calls);

  /// Asks by POST at that Unix socket, with a body of JSON.
  void open(const std::string& socket, const std::string& target,
            const std::string& body);

  void read();

  /// Calls `then` once they are written, or cannot be: true, or false.
  void write(std::string bytes, std::function<void(bool)> then);

  /// Nothing more will be written.
  void end_input();

  /// Calls nothing any more.
  void close();

private:
  using error = boost::system::error_code;

  void send_request(const std::string& request);
  void on_read(error ec, std::string_view bytes);
  void end(int status, std::string text);

  std::shared_ptr<io_core> core_;
  callbacks calls_;
  stream_socket socket_;
  std::vector<char> buffer_;
  std::string head_; ///< Of the answer, and what came with it.
  std::string writing_;
  bool open_ = false; ///< The engine has agreed.
  bool reading_ = false;
  bool over_ = false;
};

} // namespace roscell
