#pragma once

#include "actors/edge/http/client/http_client.hpp"
#include "messages/codec/json_codec.hpp"

#include <stdexcept>
#include <string>

namespace roscell::cli::top {

/// No answer, or a refusal, in one sentence.
class no_answer : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A node that threads ask which another one may have to end soon: everything
/// that waits stops waiting once `cancel` was used, and throws `no_answer`.
class node_link {
public:
  explicit node_link(http_endpoint to) : client_{std::move(to)} {}

  /// The JSON document at a path.
  json get(const std::string& path) const;

  using line_handler = std::function<bool(std::string_view line)>;

  /// Gives the lines of a reply that may never end to `on_line`, until that
  /// returns false or the reply ends.
  void follow(const std::string& path, const line_handler& on_line) const;

  void cancel() const {
    cancel_.cancel();
  }

private:
  http_client::options patience() const;

  http_client client_;
  http_cancel cancel_;
};

/// What to tell somebody of something that a node's answer has led to.
std::string reason_in(const std::exception& e);

} // namespace roscell::cli::top
