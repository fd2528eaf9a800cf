#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace roscell::ros2 {

/// What a request of rcl_interfaces/srv/SetParameters, or
/// SetParametersAtomically, asks of the cell, and the reply to it. What can
/// never be is refused here, name by name; the rest is one change, which the
/// cell makes as a whole or not at all. Pure.
class parameter_request {
public:
  /// Throws cdr_error for what is no such request. Of many parameters the first
  /// thousand are answered.
  /// @param all_or_none it is SetParametersAtomically.
  /// @param declared JSON object of the parameters that can be changed.
  /// @param values JSON object of all that there are.
  parameter_request(std::string_view request, bool all_or_none,
                    const nlohmann::json& declared,
                    const nlohmann::json& values);

  /// JSON object of the parameters that are to change; empty: nothing is left
  /// to be asked.
  const std::string& changes() const noexcept {
    return changes_;
  }

  /// @param problem why the change was not made; empty: it was.
  std::string reply(const std::string& problem) const;

private:
  bool all_or_none_;
  std::string changes_;
  std::vector<std::string> problems_; ///< Of each; empty: the cell knows.
};

} // namespace roscell::ros2
