#pragma once

#include "actors/edge/trust/limits.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
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

enum class invitation_problem {
  unknown, ///< Or used, or over: who asks is not told which.
  other_name,
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

  /// Its proof is right: it is good no more, whatever comes of the newcomer.
  std::variant<open_invitation, invitation_problem>
  use(const std::string& id, const std::string& name, time_point now);

  /// Taken back. False: there is none.
  bool remove(const std::string& id);

  std::vector<open_invitation> all(time_point now) const;

private:
  void forget_past(time_point now);

  std::map<std::string, open_invitation> by_id_;
};

} // namespace roscell
