#pragma once

#include "skills/ros2/messages/cdr.hpp"
#include "skills/ros2/messages/cdr_reader.hpp"
#include "skills/ros2/messages/cdr_writer.hpp"

/// INTERNAL to what is made from definitions, which compiles these once for
/// each message.
namespace roscell::ros2 {

template <class T>
std::string serialize(const T& message) {
  cdr_writer out;
  out.write(message);
  return std::string{out.bytes()};
}

template <class T>
T deserialize(std::string_view payload) {
  cdr_reader in{payload};
  T result;
  in.read(result);
  in.finish();
  return result;
}

} // namespace roscell::ros2
