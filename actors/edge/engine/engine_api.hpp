#pragma once

#include <string>
#include <string_view>

/// Versions of Docker's API. Each release of an engine takes a range of them,
/// and refuses what is older or newer.
namespace roscell {

/// The newest that we know.
inline constexpr std::string_view known_api = "1.41";

/// Which version to speak with an engine that offers these: the newest that we
/// know, as far as the engine takes it. Empty, which is whatever the engine
/// itself takes, where it says nothing that can be read.
std::string choose_api(std::string_view newest, std::string_view oldest);

} // namespace roscell
