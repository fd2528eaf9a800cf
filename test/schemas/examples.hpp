#pragma once

#include "messages/codec/json_codec.hpp"
#include "test/places.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace roscell::test {

/// A document that is a valid-*.json of test/schemas/examples/<type>/, or one
/// of invalid.json there: {"name", "where", "from", "patch"}, with the pointers
/// that its errors must have, and the valid one from which a JSON Patch makes
/// it. One that is like no valid one is written out as "document".
struct example {
  std::string type;
  std::string name; ///< As cell_list/valid-empty, or cell_list/invalid-uuid.
  std::string text;
  json document;
  bool valid;
  std::vector<std::string> where; ///< Sorted.
};

/// All of them, sorted by name.
std::vector<example> examples();

std::string read_file(const std::filesystem::path& path);

} // namespace roscell::test
