#pragma once

#include "messages/inside/join_diagnosis.hpp"

#include <string>

/// Why a cell is not joined, in words for the person who waits. Pure.
namespace roscell {

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
