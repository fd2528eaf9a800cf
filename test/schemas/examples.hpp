#pragma once

#include "messages/codec/json_codec.hpp"
#include "test/places.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace roscell::test {

/// One file of test/schemas/examples/<type>/. Beside an invalid one lies a
/// .where file with the pointers that its errors must have, one on each line.
struct example {
  std::string type;
  std::filesystem::path file;
  json document;
  bool valid;
  std::vector<std::string> where; ///< Sorted.
};

/// All of them, sorted by path.
std::vector<example> examples();

std::string read_file(const std::filesystem::path& path);

} // namespace roscell::test
