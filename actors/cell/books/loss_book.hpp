#pragma once

#include "actors/house/backoff.hpp"

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// A step that is to be placed anew: its node is lost and has been for long
/// enough, or its new place has come to nothing.
struct lost_step {
  std::string task;
  std::string instance;
  std::string node;                            ///< Its name,
  std::string uuid;                            ///< and whose name that was.
  std::chrono::steady_clock::time_point since; ///< Of the node's last word.
  std::chrono::steady_clock::time_point due;   ///< Of the next attempt.
  /// The fence on its node has ended it by then, if the node stayed away.
  std::chrono::steady_clock::time_point ended_by;
  backoff pause = backoff{};
  std::string trouble;   ///< Why it has no place; empty: not tried yet.
  bool given_up = false; ///< What returns of it is to end.
  /// It is not placed anew: its host starts it alone, whenever that is switched
  /// on.
  bool is_alone = false;
};

/// Steps that move because their nodes are lost. Pure; told the time.
class loss_book {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// The node of an instance is lost; it moves `after` the node's last word.
  /// One that is known to be lost stays as it is.
  void lose(lost_step x, std::chrono::milliseconds after);

  /// The same of one that its host starts alone: it does not move, and may run
  /// at any time until its node is back.
  void lose_sight(lost_step x);

  /// Forgets those of a node that is back.
  void see_again(const std::string& uuid);

  /// It is back, has moved, or is wanted no more.
  void forget(const std::string& instance);

  const lost_step* find(const std::string& instance) const;

  /// Those of a task.
  std::vector<lost_step> of_task(const std::string& task) const;

  /// Whether what returns of it is to end, since it is being placed elsewhere.
  bool is_given_up(const std::string& instance) const;

  void give_up(const std::string& instance);

  /// It has no place now: tried again after a pause that grows.
  void postpone(const std::string& instance, const std::string& trouble,
                time_point now);

  /// It is not due before then: it is being placed.
  void pause(const std::string& instance, time_point until);

  /// Those that are to be placed now, by task.
  std::map<std::string, std::vector<lost_step>> due(time_point now) const;

  time_point next_due() const;

private:
  std::map<std::string, lost_step> steps_; ///< By instance.
};

} // namespace roscell
