#include "actors/requests/handlers/forwarding.hpp"

#include "actors/core/answer_limits.hpp"
#include "messages/codec/json_codec.hpp"

#include <utility>

namespace roscell {

namespace {

/// What the coordinator says replaces what the node has said, unless it knows
/// no more; that it cannot be asked is told beside it.
failure joined_refusal(failure known, const failure& cell) {
  if (cell.code == error_code::unknown_task
      || cell.code == error_code::unknown_type)
    return known;
  if (cell.code != error_code::unreachable)
    return cell;
  known.hint = "elsewhere nobody could be asked: " + cell.message;
  return known;
}

} // namespace

void ask_coordinator(const request_context& context, const json& request,
                     const failure& known,
                     std::function<void(std::variant<json, failure>)> done) {
  const auto& membership = context.services->membership;
  if (known.code != error_code::unknown_task || !membership)
    return done(known);
  context.enter("ask_coordinator");
  context.call<request_routed>(
      membership, limits::log::stream, route_request{request.dump(), "", ""},
      [known, done](request_routed& reply) {
        auto answer = json::parse(reply.text, nullptr, false);
        if (reply.refusal.empty() && answer.is_object())
          done(std::move(answer));
        else
          done(joined_refusal(known, failure_from(answer)));
      },
      [known, done](const caf::error& why) {
        done(joined_refusal(known, to_failure(why)));
      });
}

} // namespace roscell
