#pragma once

#include <cstddef>
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

} // namespace roscell::cli
