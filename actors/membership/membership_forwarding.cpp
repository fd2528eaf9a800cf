#include "actors/membership/membership_steps.hpp"
#include "actors/session/forwarded_requests.hpp"
#include "schemas/document.hpp"

#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

request_routed refusal(const failure& why) {
  return {error_reply(why).dump(-1, ' ', false, json::error_handler_t::replace),
          to_string(why.code)};
}

failure no_coordinator(const membership_status& st, const std::string& type) {
  const auto& rows = st.report.rows();
  const auto& me = st.config.identity.name;
  failure why{error_code::unreachable,
              "a coordinator answers '" + type + "', and node '" + me
                  + "' is in no cell now",
              "", "`roscell status` shows why"};
  if (st.state == node_state::orphaned)
    why.message = "the coordinator of cell '" + st.cell + "', which answers '"
                  + type + "', is away";
  if (!rows.empty() && !rows.front().problem.empty())
    why.message += ": " + rows.front().problem;
  return why;
}

/// What must be asked where it is answered.
failure not_passed_on(const membership_status& st, const std::string& type) {
  return {
      error_code::unknown_type,
      "a member does not pass '" + type + "' on to its coordinator", "/type",
      "send it to the coordinator of cell '" + st.cell + "' at " + st.address};
}

/// The session ended before the answer came.
failure coordinator_gone(const membership_status& st,
                         const std::string& reason) {
  return {error_code::unreachable,
          "the coordinator of cell '" + st.cell + "' at " + st.address
              + " has not answered: " + reason,
          "",
          "is its host up, and its process not stopped (`ps -C roscell -o "
          "pid,stat,args` shows a T then)? `roscell status` shows when it is "
          "back; ask again then"};
}

/// What a coordinator's answer lacks: where else one may ask.
failure with_place(const membership_status& st, failure why) {
  if (why.hint.empty()
      && (why.code == error_code::conflict || why.code == error_code::timeout))
    why.hint = "ask the coordinator itself, at " + st.address;
  return why;
}

void deliver(const membership_status& st, const caf::expected<json>& reply,
             caf::typed_response_promise<request_routed> promise) {
  if (reply) {
    promise.deliver(request_routed{reply->dump(), ""});
    return;
  }
  const auto why = to_failure(reply.error());
  promise.deliver(refusal(st.session ? with_place(st, why)
                                     : coordinator_gone(st, why.message)));
}

} // namespace

caf::result<request_routed> pass_on(self_pointer self,
                                    const route_request& request) {
  auto& st = self->state;
  auto parsed = parse_document(request.text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return refusal(*why);
  const auto& body = std::get<json>(parsed);
  const auto type = body.value("type", "");
  if (st.phase != phase::joined)
    return refusal(no_coordinator(st, type));
  const auto waits = forwarding_of(type);
  if (!waits)
    return refusal(not_passed_on(st, type));
  auto promise = self->make_response_promise<request_routed>();
  st.frames.call(body, self->clock().now() + waits->member,
                 [self, promise](const caf::expected<json>& reply) {
                   deliver(self->state, reply, promise);
                 });
  set_timer(self);
  return promise;
}

} // namespace roscell::membership_steps
