#include "actors/instances/engine/engine_parts.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <memory>
#include <utility>
#include <variant>

namespace roscell {

uint64_t expect_answer(engine_runtime_pointer self,
                       engine_runtime_state::continuation then) {
  auto& st = self->state;
  const auto call = ++st.last_call;
  st.calls.emplace(call, std::move(then));
  return call;
}

engine_answered to_message(uint64_t call, engine_answer answer) {
  engine_answered result;
  result.call = call;
  if (auto* why = std::get_if<edge_error>(&answer)) {
    result.why = {why->code, std::move(why->message), {}, std::move(why->hint)};
    return result;
  }
  auto& reply = std::get<engine_reply>(answer);
  result.status = reply.status;
  result.body = std::move(reply.body);
  return result;
}

void ask_engine(engine_runtime_pointer self, engine_request what,
                engine_runtime_state::continuation then) {
  const auto call = expect_answer(self, std::move(then));
  const auto target = caf::actor_cast<engine_runtime_actor>(self);
  self->state.client->request(
      std::move(what), [target, call](engine_answer answer) {
        caf::anon_send(target, to_message(call, std::move(answer)));
      });
}

opened_call stream_lines(engine_runtime_pointer self, engine_request what,
                         engine_runtime_state::continuation then) {
  opened_call result;
  const auto call = result.call = expect_answer(self, std::move(then));
  const auto target = caf::actor_cast<engine_runtime_actor>(self);
  // Used on the io thread only.
  auto lines = std::make_shared<std::vector<std::string>>();
  auto splitter = std::make_shared<line_splitter>(
      limits::engine::line_bytes, [lines](std::string_view line) {
        lines->emplace_back(line);
        return true;
      });
  engine_stream_callbacks calls;
  calls.on_open = [target, call] {
    caf::anon_send(target, engine_streamed{call, {}});
  };
  calls.on_bytes = [target, call, lines, splitter](std::string_view bytes) {
    splitter->take(bytes);
    if (!lines->empty())
      caf::anon_send(target, engine_streamed{call, std::exchange(*lines, {})});
    return !splitter->too_long();
  };
  calls.on_end = [target, call](engine_answer answer) {
    caf::anon_send(target, to_message(call, std::move(answer)));
  };
  result.stream = self->state.client->stream(std::move(what), std::move(calls));
  return result;
}

bool is_lost(const engine_answered& x) {
  return x.status == 0;
}

bool is_good(const engine_answered& x) {
  return x.status >= 200 && x.status < 300;
}

caf::error engine_failure(const std::string& what, const engine_answered& x) {
  if (is_lost(x))
    return fail(error_code::engine_failed, what + ": " + x.why.message, {},
                x.why.hint);
  const auto why = engine_refusal(what, {x.status, x.body});
  return to_caf(why);
}

json object_of(const engine_answered& x) {
  auto result = json::parse(x.body, nullptr, false);
  return is_good(x) && result.is_object() ? result : json::object();
}

} // namespace roscell
