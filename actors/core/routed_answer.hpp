#pragma once

#include "messages/failure.hpp"
#include "messages/inside/requests.hpp"

#include <optional>

namespace roscell {

/// Why the ROUTER's answer is a refusal; none: it is none.
std::optional<failure> refusal_in(const request_routed& answer);

} // namespace roscell
