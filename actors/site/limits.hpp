#pragma once

#include <chrono>

/// How long things at a site take.
namespace roscell::limits::site {

/// For a coordinator's answer to one who asks for a fresh certificate.
constexpr std::chrono::seconds renewal{10};
/// When he asks again who got none, or looks whether it is time.
constexpr std::chrono::hours renewal_pause{1};
constexpr std::chrono::hours renewal_look{12};
/// A node that is to be made anew answers first.
constexpr std::chrono::seconds answer{1};

} // namespace roscell::limits::site
