#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace roscell {

/// How long a node has for a request that it answers about itself, and that
/// another node of its cell may send it by their coordinator; none for others.
std::optional<std::chrono::milliseconds> relayed_limit(std::string_view type);

/// What each hop on the way adds to that.
constexpr std::chrono::seconds relay_margin{2};

} // namespace roscell
