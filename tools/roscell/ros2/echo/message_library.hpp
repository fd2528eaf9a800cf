#pragma once

#include "tools/roscell/ros2/echo/message_definition.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace roscell::cli {

/// The definitions that skills are made from, by their types.
const std::map<std::string, std::string>& embedded_definitions();

/// Finds definitions of messages by their types: our own, then those that
/// workspaces have installed (PREFIX/share/PACKAGE/msg/NAME.msg).
class message_library {
public:
  /// Prefixes as in AMENT_PREFIX_PATH.
  explicit message_library(std::vector<std::filesystem::path> prefixes);

  /// Throws definition_error, which names the type and the remedy. The result
  /// lives as long as the library.
  const message_definition& find(const std::string& type);

private:
  std::string text_of(const std::string& package, const std::string& name,
                      const std::string& type) const;

  const std::vector<std::filesystem::path> prefixes_;
  std::map<std::string, message_definition> known_;
};

/// The folders of a list with colons.
std::vector<std::filesystem::path> prefixes_in(const std::string& list);

} // namespace roscell::cli
