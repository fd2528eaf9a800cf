#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace roscell::cli {

/// One field of a ROS 2 message.
struct message_field {
  std::string type; ///< "uint8", "string", "sensor_msgs/msg/PointField".
  std::string name;
  bool is_array = false;
  std::size_t items = 0; ///< Of an array of fixed length; 0: a sequence.
};

using message_definition = std::vector<message_field>;

class definition_error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Reads the text of a .msg file of `package`: fields, without constants,
/// defaults and bounds, which do not change what is on the wire. Throws
/// definition_error, which names the line.
message_definition read_definition(const std::string& package,
                                   const std::string& text);

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
