#pragma once

#include "actors/session/limits.hpp"
#include "actors/session/session_answers.hpp"
#include "actors/session/session_calls.hpp"
#include "actors/session/session_envelope.hpp"

#include <functional>
#include <optional>
#include <string>

namespace roscell {

/// What the peer wants: a request, or a notice when there is no id.
struct session_inquiry {
  std::optional<uint64_t> id;
  json body; ///< Has passed its schema.

  std::string type() const {
    return body.value("type", "");
  }
};

/// One side's half of a session's frames: it correlates, keeps repetitions
/// away, answers what is malformed, and counts it.
class session_exchange {
public:
  using time_point = session_calls::time_point;
  using send_function = std::function<void(std::string)>;

  session_exchange() = default;

  /// Sends frames by `send`.
  explicit session_exchange(send_function send);

  /// Sends a request.
  void call(const json& body, time_point deadline,
            session_calls::on_result done);

  /// False where it is larger than a frame: then nothing has been sent.
  [[nodiscard]] bool notify(const json& body);

  /// Takes one frame. Gives what is left to be done by the owner, and which
  /// `answer` is due for if it has an id.
  std::optional<session_inquiry> receive(const std::string& frame);

  /// Answers request `id`, once.
  void answer(uint64_t id, const json& body);

  /// The peer has sent too many bad frames; the session is to be closed.
  bool hopeless() const {
    return bad_frames_ >= limits::session::bad_frames;
  }

  session_calls& calls() {
    return calls_;
  }

  const session_calls& calls() const {
    return calls_;
  }

private:
  std::optional<session_inquiry> admit(session_envelope frame);

  send_function send_;
  session_calls calls_;
  session_answers answers_;
  unsigned bad_frames_ = 0;
};

} // namespace roscell
