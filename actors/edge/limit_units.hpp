#pragma once

#include <chrono>
#include <cstddef>

/// What limits are written in: each package's stand in its `limits.hpp`, each
/// with its reason, and how they nest in actors/node/nested_limits.cpp. It is
/// short because all of them include it.
namespace roscell::limits {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr size_t kib = 1024;
constexpr size_t mib = 1024 * kib;

} // namespace roscell::limits
