#pragma once

#include "messages/failure.hpp"

#include <string>
#include <variant>

namespace roscell {

/// Why something at the edge did not work, in words for the operator.
struct edge_error {
  error_code code = error_code::internal;
  std::string message; ///< What is wrong, one sentence without a full stop.
  std::string hint;    ///< What to do about it, may be empty.
};

/// A value, or why there is none.
template <class T>
using edge_result = std::variant<T, edge_error>;

} // namespace roscell
