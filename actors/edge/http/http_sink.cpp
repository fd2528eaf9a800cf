#include "actors/edge/http/http_sink.hpp"

#include "actors/edge/http/http_connection.hpp"

#include <boost/beast/http/status.hpp>

#include <utility>

namespace roscell {

namespace {

/// A page loads nothing from elsewhere, makes no code out of text, and is shown
/// inside no other.
constexpr const char* page_rules =
    "\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; "
    "style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'; "
    "require-trusted-types-for 'script'"
    "\r\nX-Content-Type-Options: nosniff"
    "\r\nReferrer-Policy: no-referrer";

class connection_sink : public reply_sink {
public:
  connection_sink(std::shared_ptr<http_shared> shared,
                  std::weak_ptr<http_connection> connection)
      : shared_(std::move(shared)), connection_(std::move(connection)) {
    // nop
  }

  void reply(http_reply reply) override {
    shared_->core->post([connection = connection_, reply = std::move(reply)] {
      if (const auto alive = connection.lock())
        alive->reply(reply);
    });
  }

  std::shared_ptr<http_stream> stream(std::string content_type) override {
    auto stream = std::make_shared<stream_connection>(
        shared_->core, shared_->limits, std::move(content_type));
    shared_->core->post([connection = connection_, stream] {
      if (const auto alive = connection.lock())
        alive->hand_over(stream);
      else
        stream->abort();
    });
    return stream_connection::make_handle(std::move(stream));
  }

private:
  std::shared_ptr<http_shared> shared_;
  std::weak_ptr<http_connection> connection_;
};

} // namespace

std::shared_ptr<reply_sink>
make_sink(std::shared_ptr<http_shared> shared,
          std::weak_ptr<http_connection> connection) {
  return std::make_shared<connection_sink>(std::move(shared),
                                           std::move(connection));
}

std::string reply_head(const http_reply& reply, bool is_last) {
  const auto reason = boost::beast::http::obsolete_reason(
      boost::beast::http::int_to_status(static_cast<unsigned>(reply.status)));
  std::string text = "HTTP/1.1 " + std::to_string(reply.status) + " ";
  text += std::string_view{reason.data(), reason.size()};
  text += "\r\nContent-Type: " + reply.content_type;
  text += "\r\nContent-Length: " + std::to_string(reply.body.size());
  text += "\r\nCache-Control: no-store";
  if (reply.content_type.rfind("text/html", 0) == 0)
    text += page_rules;
  if (reply.status == 401)
    text += "\r\nWWW-Authenticate: Bearer";
  if (reply.status == 405)
    text += "\r\nAllow: GET, POST";
  text += is_last ? "\r\nConnection: close" : "\r\nConnection: keep-alive";
  return text + "\r\n\r\n";
}

} // namespace roscell
