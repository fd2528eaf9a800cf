#pragma once

#include "actors/edge/http/handshake_queue.hpp"
#include "actors/edge/http/http_shared.hpp"
#include "actors/edge/http/http_stream_connection.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/session/session_dialog.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace roscell {

/// INTERNAL to this folder: one client of the HTTP server. Reads a request,
/// checks who asks, has it answered, and so on; or hands its socket over to a
/// stream or a session and stays in the table on their behalf. Io thread only.
class http_connection : public std::enable_shared_from_this<http_connection> {
public:
  using clock = std::chrono::steady_clock;

  http_connection(std::shared_ptr<http_shared> shared, link_socket socket,
                  bool local);

  void run();

  /// Is served later, by `run`.
  void wait_for_turn();

  /// Answers 503, whatever it wants, and closes.
  void refuse_crowd();

  /// Closes at once.
  void abort();

  /// Closes unless a request is in progress, which gets its reply.
  void drain();

  clock::time_point last_heard() const {
    return last_heard_;
  }

  /// The answers to the request in progress.
  void reply(http_reply reply);
  void hand_over(const std::shared_ptr<stream_connection>& stream);

private:
  using error = boost::system::error_code;
  using parser =
      boost::beast::http::request_parser<boost::beast::http::string_body>;

  enum class phase {
    queued,      ///< For its turn; nothing is read.
    proving,     ///< Shakes hands, or waits for its turn to.
    waiting,     ///< For the first byte of a request.
    reading,     ///< A request.
    continuing,  ///< Tells the client that the body may come.
    answering,   ///< Somebody else works on the answer.
    writing,     ///< The reply.
    lingering,   ///< For the client to read the last reply and close.
    handed_over, ///< The socket belongs to a stream or session.
    closed,
  };

  void prove();
  void shake_hands();
  void on_proved(const std::optional<distrusted>& why);
  void begin_requests();
  bool admit(const std::string& path);
  bool admit_peer(const std::string& path);
  void lead_on(const std::string& path);
  void name_caller(http_request& request);
  void next_request();
  void limit(std::chrono::milliseconds time);
  void on_time_limit();
  void read();
  void on_read(error ec, size_t size);
  void parse();
  bool parse_some();
  bool on_header();
  void on_bad_request(error ec);
  bool check_body(size_t most_bytes);
  void dispatch();
  void begin_session();
  void start_session(const std::shared_ptr<const session_acceptor>& acceptor);
  void on_written(error ec);
  void linger();
  void refuse_request(int status, error_code code, std::string_view message,
                      std::string_view hint = {});

  std::shared_ptr<http_shared> shared_;
  link_socket socket_;
  const bool local_;
  boost::asio::steady_timer timer_;
  boost::beast::flat_buffer incoming_;
  std::optional<parser> parser_;
  std::string outgoing_; ///< The head of a reply, then its body.
  std::string outgoing_body_;
  std::string more_head_; ///< Of the next reply, each line after its break.
  std::shared_ptr<stream_connection> stream_;
  std::weak_ptr<session_accept> session_;
  clock::time_point last_heard_ = clock::now();
  phase phase_ = phase::queued;
  bool header_done_ = false;
  bool last_reply_ = false;
  handshake_queue::ticket hands_ = 0; ///< 0: none.
  bool permitted_ = false;            ///< To read the path that is asked for.
  std::optional<identity> peer_;      ///< Who has proved it by TLS.
  bool newcomer_ = false;             ///< He comes for an identity.
  size_t lingered_bytes_ = 0;
  size_t body_limit_ = 0; ///< Of the request that is being read.
};

} // namespace roscell
