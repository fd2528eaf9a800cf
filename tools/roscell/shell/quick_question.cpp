#include "tools/roscell/shell/quick_question.hpp"

#include "tools/roscell/exit_code.hpp"

#include <variant>

namespace roscell::cli {

json ask_quickly(const node_client& node, const quick_question& question,
                 std::chrono::milliseconds limit, const http_cancel* cancel) {
  http_client::options how;
  how.timeout = limit;
  how.cancel = cancel;
  const auto outcome = http_client{node.endpoint()}.request(
      question.body.empty() ? "GET" : "POST", question.path, question.body,
      how);
  if (const auto* why = std::get_if<edge_error>(&outcome))
    throw command_error{exit_unreachable, why->message, why->hint};
  auto reply = json::parse(std::get<http_reply>(outcome).body, nullptr, false);
  if (!reply.is_object())
    throw command_error{exit_unreachable,
                        node.where().text() + " is no node: it gave no JSON"};
  return unless_refused(std::move(reply), false);
}

} // namespace roscell::cli
