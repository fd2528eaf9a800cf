#include "roscell/client.hpp"

#include "actors/edge/http/client/http_client.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "client/event_follower.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

/// A node that lives answers a question about itself far sooner.
constexpr std::chrono::seconds answer_limit{10};

constexpr int status_ok = 200;

client_error to_client_error(const edge_error& why) {
  return {std::string{to_string(why.code)}, why.message, why.hint};
}

json document_of(const http_reply& reply) {
  auto document = json::parse(reply.body, nullptr, false);
  if (!document.is_object())
    throw client_error{"unreachable",
                       "no node: it answered with status "
                           + std::to_string(reply.status) + " and no JSON",
                       "is another program listening there?"};
  return document;
}

/// The text at a name of an object; empty where there is none.
std::string text_at(const json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_string() ? i->get<std::string>() : "";
}

[[noreturn]] void throw_refusal(const http_reply& reply) {
  const auto document = document_of(reply);
  const auto why = document.find("error");
  if (why == document.end() || !why->is_object())
    throw client_error{"internal", reply.body, ""};
  throw client_error{text_at(*why, "code"), text_at(*why, "message"),
                     text_at(*why, "hint")};
}

const http_reply& checked(const edge_result<http_reply>& result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    throw to_client_error(*why);
  return std::get<http_reply>(result);
}

/// Null: the target has none.
std::shared_ptr<site_identity> identity_of(const client_target& to) {
  if (to.identity_file.empty() || !to.socket.empty())
    return nullptr;
  auto read = site_identity::in_file(to.identity_file);
  if (const auto* why = std::get_if<edge_error>(&read))
    throw to_client_error(*why);
  return std::get<std::shared_ptr<site_identity>>(std::move(read));
}

} // namespace

class client_cancel::impl {
public:
  http_cancel cancel;
};

client_cancel::client_cancel() : impl_(std::make_unique<impl>()) {}

client_cancel::~client_cancel() = default;

void client_cancel::cancel() const {
  impl_->cancel.cancel();
}

class client::impl {
public:
  explicit impl(const client_target& to)
      : http_(http_endpoint{to.socket, to.host, to.port, to.token,
                            identity_of(to)}) {}

  http_reply ask(const char* method, const std::string& path,
                 const std::string& body,
                 std::chrono::milliseconds limit) const {
    http_client::options how;
    how.timeout = limit;
    how.when_cut_off =
        edge_error{error_code::unreachable,
                   "the node went away while it worked on the request",
                   "ask again once it is back"};
    return checked(http_.request(method, path, body, how));
  }

  void follow(const std::string& path,
              const std::function<bool(std::string_view)>& on_line,
              const client_cancel* cancel) const {
    http_client::options how;
    how.timeout = answer_limit;
    how.cancel = cancel == nullptr ? nullptr : &cancel->parts().cancel;
    const auto result = http_.follow(path, on_line, how);
    const auto* why = std::get_if<edge_error>(&result);
    // That is how a cancelled call ends.
    if (why != nullptr && cancel != nullptr
        && why->code == error_code::conflict)
      return;
    if (const auto& reply = checked(result); reply.status != status_ok)
      throw_refusal(reply);
  }

private:
  http_client http_;
};

client::client(const client_target& to) : impl_(std::make_unique<impl>(to)) {}

client::~client() = default;

client::client(client&&) noexcept = default;

client& client::operator=(client&&) noexcept = default;

std::string client::request(const std::string& json,
                            std::chrono::milliseconds limit) const {
  const auto reply = impl_->ask("POST", "/v1/requests", json, limit);
  document_of(reply);
  return reply.body;
}

std::string client::get(const std::string& path) const {
  auto reply = impl_->ask("GET", path, "", answer_limit);
  document_of(reply);
  if (reply.status != status_ok)
    throw_refusal(reply);
  return std::move(reply.body);
}

void client::follow_events(
    std::uint64_t since, const std::function<bool(const node_event&)>& on_event,
    const client_cancel* cancel) const {
  event_stream events;
  impl_->follow(
      "/v1/events?since=" + std::to_string(since),
      [&](std::string_view line) {
        const auto x = events.add_line(line);
        return !x
               || on_event({x->sequence, x->time_unix_ms, x->what, x->subject,
                            x->data});
      },
      cancel);
}

void client::follow_log(
    const std::string& instance,
    const std::function<bool(std::string_view line)>& on_line,
    const client_cancel* cancel) const {
  impl_->follow("/v1/instances/" + instance + "/logs?follow=true", on_line,
                cancel);
}

} // namespace roscell
