#pragma once

#include "actors/edge/http/client/http_client.hpp"
#include "client/event_follower.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/event.hpp"
#include "messages/inside/storage.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/exit_code.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// A node has answered with an error.
class refused : public std::runtime_error {
public:
  // Parentheses: braces would make an array of it.
  explicit refused(json reply)
      : std::runtime_error{"refused"}, reply(std::move(reply)) {}

  json reply;           ///< {"type":"error","error":{...}}
  bool as_json = false; ///< Print it on standard output.
};

/// What a command ends with that such an error reply has ended: a node that
/// the asked one cannot reach is no more there than one that does not answer.
exit_code exit_code_of_refusal(const json& refusal);

/// The reply, unless it is an error: that is thrown as `refused`.
json unless_refused(json reply, bool as_json);

/// How the node to talk to was named on the command line.
struct connection_options {
  std::string to;
  std::filesystem::path token_file;
  std::filesystem::path identity_file;
};

/// Adds --to and --token-file.
void add_connection_options(CLI::App& command, connection_options& options);

/// How long an answer is waited for, and what ends the wait from another
/// thread. A node that lives answers a question about itself far sooner.
struct patience {
  std::chrono::milliseconds limit = std::chrono::seconds{15};
  const http_cancel* cancel = nullptr;
};

/// One node, asked over HTTP. Every function throws `refused` for an error
/// reply and command_error if the node cannot be reached, or has nothing to say
/// and does not say that it lives either. $ROSCELL_TIMEOUT shortens each wait.
/// Safe to be shared by threads.
class node_client {
public:
  explicit node_client(const connection_options& options);

  /// The JSON document at `path`.
  json get(const std::string& path, const patience& how = {}) const;

  /// The bytes at `path`.
  std::string get_bytes(const std::string& path, const patience& how) const;

  /// The reply to a request, waited for `limit`. An error reply is returned
  /// like any other.
  json post(const std::string& path, const std::string& body,
            std::chrono::milliseconds limit) const;

  /// The reply to a request of the vocabulary, waited for `limit`; an error
  /// reply is thrown.
  json ask(const json& request, std::chrono::milliseconds limit) const;

  using line_handler = event_follower::line_handler;

  /// Gives the lines of a reply that may never end to `on_line`, until that
  /// returns false, the reply ends, or `cancel` is used from another thread.
  void follow(const std::string& path, const line_handler& on_line,
              const http_cancel* cancel = nullptr) const;

  const target& where() const {
    return to_;
  }

  /// The same, with what it is asked with.
  const http_endpoint& endpoint() const {
    return http_.endpoint();
  }

private:
  target to_;
  http_client http_;
};

/// The events after number `since` that the node has in memory, the oldest
/// first.
std::vector<event> kept_events_of(const node_client& node, uint64_t since = 0);

/// A part of those that the node has on its disk; an empty one is the end.
std::vector<event> past_events_of(const node_client& node,
                                  const past_events_query& query);

/// Reads of the node for who follows its events, which must not outlive it.
event_follower::line_reader lines_of(const node_client& node);

/// What to say of something that a node's answer has led to; null: that it has
/// ended the stream.
std::string reason_in(const std::exception_ptr& why);

using event_handler = std::function<bool(const event& e)>;

/// The same for the node's events after number `since`.
void follow_events(const node_client& node, uint64_t since,
                   const event_handler& on_event,
                   const http_cancel* cancel = nullptr);

} // namespace roscell::cli
