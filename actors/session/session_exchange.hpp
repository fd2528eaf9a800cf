#pragma once

#include "actors/session/limits.hpp"
#include "actors/session/session_calls.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace roscell {

/// The requests that one side of a session has been sent, so that one that is
/// delivered twice is done once: ids count up, and the latest are remembered.
class session_answers {
public:
  enum class verdict {
    fresh,  ///< To be done, then `record`.
    busy,   ///< Being done; its answer will come.
    repeat, ///< Done: `text` is the answer.
    stale,  ///< Done so long ago that it is not known any more.
    crowded ///< As many as can be remembered are being done.
  };

  struct admission {
    verdict what;
    std::string text;
  };

  admission admit(uint64_t id);

  /// Keeps the answer to an admitted request: the text of its frame.
  void record(uint64_t id, const std::string& text);

private:
  struct answer {
    bool done = false;
    std::string text; ///< Empty: too large to be kept.
  };

  /// Makes room for one more; false if all of them are being done.
  bool drop_oldest_done();

  uint64_t forgotten_ = 0; ///< The highest id that is not known any more.
  std::map<uint64_t, answer> answers_;
};

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

/// How long the two ends of a session wait for a request that a member passes
/// on to its coordinator.
struct forwarding_limits {
  std::chrono::milliseconds coordinator; ///< For what answers it there.
  std::chrono::milliseconds member;      ///< For the coordinator, longer.
};

/// The limits of a type that members pass on; none if that type is not passed
/// on. What takes nodes out of cells is not: the session that would bring the
/// answer may end by it.
std::optional<forwarding_limits> forwarding_of(const std::string& type);

} // namespace roscell
