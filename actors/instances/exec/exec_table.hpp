#pragma once

#include "actors/instances/exec/exec_output.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// One command beside an instance, as far as it is known.
struct exec_session {
  using time_point = std::chrono::steady_clock::time_point;

  std::string instance;
  bool terminal = false;
  time_point began;
  time_point heard; ///< When somebody has asked for anything of it.
  exec_backlog output;
  /// Outputs that are not read until there is room: errors are the second.
  bool held[2] = {false, false};
  int64_t input_offset = 0;   ///< Of what it is to be given next.
  bool input_pending = false; ///< It has not taken what it was given last.
  bool input_ended = false;   ///< Nothing more may be given.
  bool end_pending = false;   ///< It has not heard of that.
  bool ended = false;
  int exit_code = 0;
  std::string reason; ///< Why it was ended; empty: by itself.
};

/// The commands that operators run on a node. Bounded; told the time.
class exec_table {
public:
  using time_point = exec_session::time_point;

  /// Null: there are as many as there may be.
  exec_session* begin(const std::string& id, const std::string& instance,
                      bool terminal, time_point now);

  /// Null: there is none of that name.
  exec_session* find(const std::string& id);

  /// The same for somebody who asks for something of it.
  exec_session* hear_of(const std::string& id, time_point now);

  void remove(const std::string& id);

  /// Of which nobody has asked for anything for too long.
  std::vector<std::string> lapsed(time_point now) const;

  /// When the next one lapses; none: there are no commands.
  std::optional<time_point> next_lapse() const;

  const std::map<std::string, exec_session>& all() const {
    return sessions_;
  }

private:
  std::map<std::string, exec_session> sessions_;
};

/// What becomes of input for a command.
enum class exec_verdict {
  take,     ///< It is to be given to it.
  known,    ///< It has been given to it already.
  wait,     ///< It has not taken what came before.
  note_end, ///< The same, and only the end is to be told.
  misplaced ///< Other input comes next, or none.
};

exec_verdict judge_input(const exec_session& x, int64_t offset, size_t bytes);

/// A program without its folder and its arguments, which may hold secrets.
std::string first_word(const std::vector<std::string>& command);

} // namespace roscell
