#pragma once

#include "messages/event.hpp"

namespace roscell {

/// How loud a log tells an event.
enum class loudness { debug, info, warning };

/// What has gone wrong is a warning; where an instance is on its way to is for
/// those who look closely.
loudness loudness_of(const event& e);

} // namespace roscell
