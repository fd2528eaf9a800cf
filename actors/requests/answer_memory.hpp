#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>

namespace roscell {

/// The requests that carry a `request_id`, and their answers: the same one
/// again gets the same answer. Bounded: the oldest answers go, but none that is
/// still worked on.
class answer_memory {
public:
  enum class status {
    unknown,  ///< To be worked on.
    begun,    ///< The same request is worked on.
    answered, ///< The same request has its answer.
    taken,    ///< Another request has this id.
  };

  status look(const std::string& id, const std::string& body) const;

  /// Of an id that is `answered`.
  const std::string& answer(const std::string& id) const;

  /// An `unknown` one is worked on from now on.
  void begin(const std::string& id, const std::string& body);

  /// It has been done, for the first time or once more, unless it was forgotten
  /// meanwhile.
  void finish(const std::string& id, const std::string& answer);

  /// It was refused, and may be tried again under its id.
  void forget(const std::string& id);

  size_t size() const {
    return requests_.size();
  }

private:
  struct request {
    std::string body;
    std::string answer; ///< Empty while it is worked on.
  };

  void trim();

  std::map<std::string, request> requests_;
  std::deque<std::string> order_; ///< The oldest first.
  size_t bytes_ = 0;
};

} // namespace roscell
