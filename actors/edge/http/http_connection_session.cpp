#include "actors/edge/http/http_connection.hpp"

#include <boost/beast/websocket/rfc6455.hpp>

#include <utility>

/// How a connection becomes a session.
namespace roscell {

void http_connection::begin_session() {
  const auto& acceptor = shared_->sessions;
  const auto& request = parser_->get();
  if (!acceptor)
    return refuse_request(
        404, error_code::conflict,
        "this node takes no sessions, it coordinates no cell");
  if (!boost::beast::websocket::is_upgrade(request) || !parser_->is_done()
      || incoming_.size() > 0)
    return refuse_request(400, error_code::schema_violation,
                          "a session begins with a request for a WebSocket");
  // Only browsers send this field. A page that someone looks at on this host
  // must not become a member of the cell.
  if (request.count(http::field::origin) != 0)
    return refuse_request(403, error_code::unauthorized,
                          "a session cannot be opened by a web page");
  if (shared_->open_sessions >= shared_->limits.sessions)
    return refuse_request(
        503, error_code::conflict, "too many sessions are open",
        "one node coordinates " + std::to_string(shared_->limits.sessions)
            + " sessions; use another coordinator");
  if (!shared_->table.promote(this, http_group::joining))
    return refuse_crowd();
  start_session(acceptor);
}

void http_connection::start_session(
    const std::shared_ptr<const session_acceptor>& acceptor) {
  phase_ = phase::handed_over;
  timer_.cancel();
  session_accept::hooks hooks;
  hooks.on_decided = [self = shared_from_this()](bool accepted) {
    if (accepted)
      ++self->shared_->open_sessions;
    self->abort();
  };
  hooks.on_gone = [shared = shared_] { --shared->open_sessions; };
  auto session = std::make_shared<session_accept>(
      shared_->core, std::move(socket_), acceptor, std::move(hooks));
  session_ = session;
  session->run(parser_->release());
}

} // namespace roscell
