#pragma once

#include <cstdint>
#include <map>
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

} // namespace roscell
