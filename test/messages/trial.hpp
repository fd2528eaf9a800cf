#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>
#include <vector>

namespace roscell::test {

/// What can be tried with one described struct, its type left behind.
struct trial {
  std::string name; ///< Of the schema; for a part of a message, of the struct.
  size_t members = 0;         ///< How many the struct has.
  size_t fields = 0;          ///< How many its `fields()` tell of.
  json full;                  ///< A sample with every field set.
  json least;                 ///< A sample with the fields that always appear.
  bool full_survives = false; ///< Encoded, parsed and decoded, it is the same.
  bool least_survives = false;
  bool (*decodes)(const json&) = nullptr;
};

/// Every struct that has a schema of its own.
std::vector<trial> message_trials();

/// The structs that these are made of.
std::vector<trial> part_trials();

} // namespace roscell::test
