#include "tools/roscell/top/follow/node_link.hpp"

#include "messages/failure.hpp"

#include <variant>

namespace roscell::cli::top {

namespace {

/// A coordinator waits for its members for less.
constexpr std::chrono::seconds longest_answer{10};
constexpr int status_ok = 200;

const http_reply& answered(const edge_result<http_reply>& result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    throw no_answer{why->message};
  return std::get<http_reply>(result);
}

json document_in(const http_reply& reply) {
  auto document = json::parse(reply.body, nullptr, false);
  if (!document.is_object())
    throw no_answer{"what answers there is no node"};
  if (reply.status != status_ok)
    throw no_answer{failure_from(document).message};
  return document;
}

} // namespace

http_client::options node_link::patience() const {
  http_client::options result;
  result.timeout = longest_answer;
  result.cancel = &cancel_;
  return result;
}

json node_link::get(const std::string& path) const {
  return document_in(answered(client_.request("GET", path, "", patience())));
}

void node_link::follow(const std::string& path,
                       const line_handler& on_line) const {
  const auto result = client_.follow(path, on_line, patience());
  const auto& reply = answered(result);
  if (reply.status != status_ok)
    document_in(reply);
}

std::string reason_in(const std::exception& e) {
  if (dynamic_cast<const no_answer*>(&e) != nullptr)
    return e.what();
  return std::string{"the answer is not of this version: "} + e.what();
}

} // namespace roscell::cli::top
