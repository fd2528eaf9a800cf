#include "actors/edge/http/client/http_call.hpp"

#include "actors/edge/http/client/http_exchange.hpp"
#include "actors/edge/http/limits.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

std::string text_of(int system_error) {
  return std::generic_category().message(system_error);
}

} // namespace

std::string http_endpoint::name() const {
  return socket_path.empty() ? address + ":" + std::to_string(port)
                             : "'" + socket_path + "'";
}

http_call::http_call()
    : timeout{limits::cell::registration_call},
      max_header_bytes{limits::http::header_bytes},
      max_reply_bytes{limits::http::exchanged_bytes} {
  // nop
}

http_subscription::http_subscription(std::shared_ptr<io_core> core,
                                     std::shared_ptr<http_exchange> exchange)
    : core_(std::move(core)), exchange_(std::move(exchange)) {
  // nop
}

http_subscription&
http_subscription::operator=(http_subscription&& other) noexcept {
  if (this != &other) {
    cancel();
    core_ = std::move(other.core_);
    exchange_ = std::move(other.exchange_);
  }
  return *this;
}

http_subscription::~http_subscription() {
  cancel();
}

void http_subscription::cancel() noexcept {
  if (exchange_)
    core_->post([exchange = std::move(exchange_)] { exchange->cancel(); });
  exchange_ = nullptr;
}

void call_http(const std::shared_ptr<io_core>& core, http_call what,
               std::function<void(http_outcome)> on_end) {
  http_callbacks calls;
  calls.on_end = std::move(on_end);
  auto exchange =
      std::make_shared<http_exchange>(core, std::move(what), std::move(calls));
  core->post([exchange = std::move(exchange)] { exchange->start(); });
}

http_subscription subscribe_http(const std::shared_ptr<io_core>& core,
                                 http_call what, http_callbacks calls) {
  auto exchange =
      std::make_shared<http_exchange>(core, std::move(what), std::move(calls));
  core->post([exchange] { exchange->start(); });
  return {core, std::move(exchange)};
}

edge_error describe_http_failure(const http_failure& why,
                                 const http_call& what) {
  const auto name = what.to.name();
  switch (why.what) {
  case http_failure::kind::bad_call:
    return {error_code::schema_violation, why.reason, ""};
  case http_failure::kind::no_connection:
    if (why.system_error == EACCES && !what.to.socket_path.empty())
      return {error_code::unauthorized,
              "may not open " + name + ": " + text_of(why.system_error), ""};
    return {error_code::unreachable,
            "cannot connect to " + name + ": " + text_of(why.system_error),
            "is the node running?"};
  case http_failure::kind::distrusted:
    return {error_code::unauthorized, name + " is not believed: " + why.reason,
            "a node that has no identity speaks plain HTTP, and one that has "
            "speaks TLS with its site alone"};
  case http_failure::kind::no_file:
    return {error_code::unreachable,
            "cannot read '" + what.file.string()
                + "': " + text_of(why.system_error),
            ""};
  case http_failure::kind::timeout:
    return {error_code::timeout,
            name + " did not answer within "
                + std::to_string(what.timeout.count()) + " ms",
            ""};
  case http_failure::kind::silent:
    return {error_code::unreachable,
            name
                + " is silent: it takes connections and answers nothing, not "
                  "even whether it lives",
            "its process is stopped or its host hangs; on that host `ps -C "
            "roscell -o pid,stat,args` shows a T for one that is stopped, and "
            "`kill -CONT PID` lets it go on"};
  case http_failure::kind::cut_off:
    return {error_code::unreachable,
            name + " ended the connection before it had answered",
            "was it stopped? ask again when it is back"};
  case http_failure::kind::too_long:
    return {error_code::unreachable,
            "the reply of " + name + " is longer than "
                + std::to_string(what.max_reply_bytes) + " bytes",
            ""};
  case http_failure::kind::stopped:
    return {error_code::unreachable,
            "the io thread stopped before " + name + " answered", ""};
  case http_failure::kind::cancelled:
    return {error_code::conflict, "cancelled", ""};
  case http_failure::kind::broken:
    break;
  }
  return {error_code::unreachable,
          name + " gave no reply that can be read: " + why.reason, ""};
}

edge_result<http_reply> to_edge_result(http_outcome outcome,
                                       const http_call& what) {
  if (const auto* why = std::get_if<http_failure>(&outcome))
    return describe_http_failure(*why, what);
  return std::get<http_reply>(std::move(outcome));
}

} // namespace roscell
