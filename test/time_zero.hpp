#pragma once

#include <chrono>

/// The instant at which tests of what is told the time begin: any but zero,
/// which might stand for "never".
inline constexpr std::chrono::steady_clock::time_point time_zero{
    std::chrono::hours{100}};
