#pragma once

#include "actors/edge/trust/limits.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// An invitation as whoever has made it keeps it.
struct open_invitation {
  std::string id;      ///< See `id_of_invitation`.
  std::string proving; ///< See `proving_half`.
  std::string name;    ///< The node that it is for; empty: any.
  std::string role = "node";
  std::string deposit; ///< What the newcomer gets in place of a certificate.
  int64_t made_unix_ms = 0;
  std::chrono::steady_clock::time_point until;
};

/// The open invitations of a coordinator, each good once. Pure; told the time,
/// by a clock that nobody sets.
class invitation_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// False: there are too many.
  bool add(open_invitation x, time_point now);

  /// Null: it is unknown, used or over.
  const open_invitation* find(const std::string& id, time_point now) const;

  /// Whoever has proved it gets what he came for: it is good no more. False: it
  /// is unknown, used or over.
  bool use(const std::string& id, time_point now);

  std::vector<open_invitation> all(time_point now) const;

private:
  void forget_past(time_point now);

  std::map<std::string, open_invitation> by_id_;
};

} // namespace roscell
