#include "tools/roscell/client/node_client.hpp"

#include "messages/failure.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <variant>

namespace roscell::cli {

namespace {

/// A request may take minutes, but a node that has nothing to say meanwhile is
/// asked whether it lives, which no work of its own keeps it from answering:
/// one that is stopped costs a command 11 s.
http_client::proof_of_life proof_of_life() {
  return {"/healthz", std::chrono::seconds{4}, std::chrono::seconds{7}};
}

/// Of $ROSCELL_TIMEOUT, which those set who cannot wait, as completions of
/// shells; none: no more is wanted than a proof of life.
std::optional<std::chrono::milliseconds> patience_of_user() {
  const auto* text = std::getenv("ROSCELL_TIMEOUT");
  if (text == nullptr || *text == '\0')
    return std::nullopt;
  try {
    return parse_duration(text);
  } catch (const std::invalid_argument& e) {
    throw command_error{exit_usage,
                        std::string{"ROSCELL_TIMEOUT: "} + e.what()};
  }
}

http_client::options waiting_for(std::chrono::milliseconds limit) {
  http_client::options result;
  result.timeout = std::min(limit, patience_of_user().value_or(limit));
  result.proof = proof_of_life();
  return result;
}

std::string check_target(const std::string& text) {
  try {
    parse_target(text);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

target target_of(const connection_options& options) {
  return options.to.empty() ? default_target() : parse_target(options.to);
}

http_endpoint endpoint_of(const target& to, const connection_options& options) {
  if (to.is_local())
    return {to.socket.string(), "", 0, ""};
  if (auto own = find_identity(options.identity_file, to))
    return {"", to.host, to.port, "", std::move(own)};
  return {"", to.host, to.port, find_token(options.token_file, to)};
}

[[noreturn]] void give_up(const edge_error& why) {
  auto hint = why.hint;
  if (why.code == error_code::unauthorized && hint.empty())
    hint = "this user is not allowed to: use sudo, become a member of the "
           "socket's group, or ask over TCP with --to ADDRESS --token-file "
           "FILE";
  else if (why.code == error_code::timeout)
    hint = "the node may still be working on it; `roscell tasks` and `roscell "
           "transfers` show what becomes of it";
  else if (hint.empty())
    hint = "is `roscell node` running there? --to or ROSCELL_TO names another";
  throw command_error{exit_unreachable, why.message, hint};
}

/// The JSON document in a reply; anything else comes from no node.
json document_of(const target& to, const http_reply& reply) {
  auto document = json::parse(reply.body, nullptr, false);
  if (!document.is_object())
    throw command_error{exit_unreachable,
                        to.text() + " is no node: it answered with status "
                            + std::to_string(reply.status) + " and no JSON"};
  return document;
}

/// What a request may find when the node is stopped in the middle of it. What
/// was done already is not done twice: a task's request names the task.
edge_error node_ended_while(const std::string& body) {
  const auto request = json::parse(body, nullptr, false);
  const bool deploys =
      request.is_object() && request.value("type", json{}) == "task_request";
  return {error_code::unreachable,
          deploys ? "the node ended while it deployed"
                  : "the node ended while it worked on the request",
          deploys ? "ask again with the same file once it is back"
                  : "ask again once it is back"};
}

const http_reply& checked(const edge_result<http_reply>& result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    give_up(*why);
  return std::get<http_reply>(result);
}

constexpr int status_ok = 200;

} // namespace

exit_code exit_code_of_refusal(const json& refusal) {
  return failure_from(refusal).code == error_code::unreachable
             ? exit_unreachable
             : exit_refused;
}

json unless_refused(json reply, bool as_json) {
  if (reply.value("type", "") != "error")
    return reply;
  refused why{std::move(reply)};
  why.as_json = as_json;
  throw why;
}

void add_connection_options(CLI::App& command, connection_options& options) {
  command
      .add_option("--to", options.to,
                  "Node to talk to: unix:/path, /path, or host[:port]. "
                  "Default: $ROSCELL_TO, else this machine's node")
      ->check(CLI::Validator{check_target, "TARGET"})
      ->option_text("WHERE");
  command
      .add_option("--token-file", options.token_file,
                  "Bearer token for TCP. Default: $ROSCELL_TOKEN, else, for "
                  "an address of this machine, its node's token")
      ->option_text("FILE");
  command
      .add_option("--identity", options.identity_file,
                  "Who asks over TCP, at a site of identities. Default: "
                  "$ROSCELL_IDENTITY")
      ->option_text("FILE");
}

node_client::node_client(const connection_options& options)
    : to_{target_of(options)}, http_{endpoint_of(to_, options)} {}

json node_client::get(const std::string& path, const patience& how) const {
  auto waiting = waiting_for(how.limit);
  waiting.cancel = how.cancel;
  const auto result = http_.request("GET", path, "", waiting);
  const auto& reply = checked(result);
  auto document = document_of(to_, reply);
  if (reply.status != status_ok)
    throw refused(std::move(document));
  return document;
}

std::string node_client::get_bytes(const std::string& path,
                                   const patience& how) const {
  auto waiting = waiting_for(how.limit);
  waiting.cancel = how.cancel;
  auto result = http_.request("GET", path, "", waiting);
  const auto& reply = checked(result);
  if (reply.status != status_ok)
    throw refused(document_of(to_, reply));
  return reply.body;
}

json node_client::post(const std::string& path, const std::string& body,
                       std::chrono::milliseconds limit) const {
  auto how = waiting_for(limit);
  how.when_cut_off = node_ended_while(body);
  const auto result = http_.request("POST", path, body, how);
  return document_of(to_, checked(result));
}

json node_client::ask(const json& request,
                      std::chrono::milliseconds limit) const {
  auto reply = post("/v1/requests", request.dump(), limit);
  if (reply.value("type", "") == "error")
    throw refused(std::move(reply));
  return reply;
}

void node_client::follow(const std::string& path, const line_handler& on_line,
                         const http_cancel* cancel) const {
  auto how = waiting_for(patience{}.limit);
  how.cancel = cancel;
  const auto result = http_.follow(path, on_line, how);
  const auto* why = std::get_if<edge_error>(&result);
  if (why != nullptr && cancel != nullptr && why->code == error_code::conflict)
    return;
  const auto& reply = checked(result);
  if (reply.status != status_ok)
    throw refused(document_of(to_, reply));
}

namespace {

std::vector<event> events_at(const node_client& node, const std::string& path) {
  std::vector<event> result;
  event_stream events;
  node.follow(path, [&](std::string_view line) {
    if (auto complete = events.add_line(line))
      result.push_back(std::move(*complete));
    return true;
  });
  return result;
}

} // namespace

std::vector<event> kept_events_of(const node_client& node, uint64_t since) {
  return events_at(node, "/v1/events?follow=0&since=" + std::to_string(since));
}

// A node of an earlier version, which has nothing on its disk, gives what is in
// its memory instead.
std::vector<event> past_events_of(const node_client& node,
                                  const past_events_query& query) {
  return events_at(
      node, "/v1/events?follow=0&past=1&since=" + std::to_string(query.since)
                + "&since_unix_ms=" + std::to_string(query.since_unix_ms)
                + "&newest=" + std::to_string(query.newest));
}

event_follower::line_reader lines_of(const node_client& node) {
  return [&node](const std::string& path,
                 const event_follower::line_handler& on_line,
                 const http_cancel& cancel) {
    node.follow(path, on_line, &cancel);
  };
}

std::string reason_in(const std::exception_ptr& why) {
  if (!why)
    return "the node has ended the stream of events";
  try {
    std::rethrow_exception(why);
  } catch (const command_error& e) {
    return e.what();
  } catch (const refused& e) {
    return failure_from(e.reply).message;
  } catch (const std::exception& e) {
    return std::string{"the answer is not of this version: "} + e.what();
  }
}

void follow_events(const node_client& node, uint64_t since,
                   const event_handler& on_event, const http_cancel* cancel) {
  event_stream events;
  node.follow(
      "/v1/events?since=" + std::to_string(since),
      [&](std::string_view line) {
        const auto complete = events.add_line(line);
        return !complete || on_event(*complete);
      },
      cancel);
}

} // namespace roscell::cli
