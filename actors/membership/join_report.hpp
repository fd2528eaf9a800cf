#pragma once

#include "messages/inside/membership.hpp"
#include "messages/node.hpp"

#include <chrono>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// How a node's attempts to come into a cell go, for `roscell status`, and when
/// it is time to speak of it in the log. Pure: it is told the time.
class join_report {
public:
  using time_point = std::chrono::steady_clock::time_point;

  join_report();

  /// An attempt begins; `address` is empty where any cell will do.
  void begin(const std::string& address, int64_t now_unix_ms);

  /// What is wrong. True if it is to be told now: it is news, or what was told
  /// last is some time ago, ever longer.
  bool note(const std::string& problem, const std::string& hint,
            time_point now);

  /// When what has been told is worth telling again.
  time_point next() const {
    return next_;
  }

  /// The node is in a cell, or wants none any more.
  void clear();

  /// At most one: none if no attempt has begun.
  const std::vector<join_failure>& rows() const {
    return rows_;
  }

private:
  std::vector<join_failure> rows_;
  std::set<std::string> reported_;
  std::chrono::milliseconds pause_;
  time_point next_; ///< When what was told before is told again.
};

// Why a cell is not joined, in words for the person who waits. Pure.

/// What is wrong, and what to do about it.
struct join_diagnosis {
  std::string problem; ///< A sentence without its period.
  std::string hint;    ///< The same; may be empty.
};

/// What is tried.
struct join_question {
  std::string
      address;       ///< "host:port" of the discovery server, as it was given.
  uint16_t port = 0; ///< Of `address`.
};

/// What is wrong at an address whose discovery server has not answered.
join_diagnosis diagnose(const join_question& asked, const server_probed& found);

/// The same for a discovery server that was found, whose coordinator's session
/// port `session` did not let the node in for `reason`.
join_diagnosis diagnose_session(const std::string& session,
                                const std::string& reason);

/// The same for a node that asks whoever it sees for a place, and sees nobody.
join_diagnosis diagnose_solitude(int64_t public_domain);

} // namespace roscell
