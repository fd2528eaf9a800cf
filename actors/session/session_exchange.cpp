#include "actors/session/session_exchange.hpp"

#include "actors/edge/session/limits.hpp"

#include <utility>

namespace roscell {

namespace {

std::string reply_text(uint64_t id, const json& body) {
  return write_envelope(envelope_kind::reply, id, body);
}

json refusal(error_code code, std::string message) {
  return error_reply({code, std::move(message), "", "", ""});
}

} // namespace

session_exchange::session_exchange(send_function send)
    : send_(std::move(send)) {}

void session_exchange::call(const json& body, time_point deadline,
                            session_calls::on_result done) {
  if (auto text = calls_.begin(body, deadline, std::move(done)))
    send_(std::move(*text));
}

bool session_exchange::notify(const json& body) {
  auto text = write_envelope(envelope_kind::notice, 0, body);
  if (text.size() > limits::session::frame_bytes)
    return false;
  send_(std::move(text));
  return true;
}

std::optional<session_inquiry>
session_exchange::receive(const std::string& frame) {
  auto envelope = read_envelope(frame);
  if (!envelope) {
    ++bad_frames_;
    return std::nullopt;
  }
  if (envelope->refused)
    ++bad_frames_;
  switch (envelope->kind) {
  case envelope_kind::reply:
    // One that nobody waits for comes late or again: no harm, no use.
    calls_.finish(*envelope);
    return std::nullopt;
  case envelope_kind::request:
    return admit(std::move(*envelope));
  case envelope_kind::notice:
    break;
  }
  if (envelope->refused)
    return std::nullopt;
  return session_inquiry{std::nullopt, std::move(envelope->body)};
}

void session_exchange::answer(uint64_t id, const json& body) {
  auto text = reply_text(id, body);
  if (text.size() > limits::session::frame_bytes)
    text = reply_text(id, refusal(error_code::conflict,
                                  "the answer is too large for a session"));
  answers_.record(id, text);
  send_(std::move(text));
}

std::optional<session_inquiry> session_exchange::admit(session_envelope frame) {
  using verdict = session_answers::verdict;
  if (frame.refused) {
    send_(reply_text(frame.id, error_reply(*frame.refused)));
    return std::nullopt;
  }
  auto admission = answers_.admit(frame.id);
  switch (admission.what) {
  case verdict::fresh:
    return session_inquiry{frame.id, std::move(frame.body)};
  case verdict::busy:
    break;
  case verdict::repeat:
    send_(std::move(admission.text));
    break;
  case verdict::stale:
    send_(reply_text(frame.id, refusal(error_code::conflict,
                                       "this request has been answered")));
    break;
  case verdict::crowded:
    send_(reply_text(
        frame.id, refusal(error_code::conflict, "too many requests at once")));
    break;
  }
  return std::nullopt;
}

} // namespace roscell
