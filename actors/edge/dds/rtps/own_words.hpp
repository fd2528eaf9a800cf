#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// What a participant tells of itself.
struct own_words {
  std::string name;         ///< Of the participant; may be empty.
  std::string announcement; ///< Its USER_DATA; may be empty.
};

/// The first thing that the sender of a message tells of itself in it, none if
/// that is nothing. Any bytes will do.
std::optional<own_words> own_words_in(std::uint8_t* message, std::size_t size);

} // namespace roscell
