#pragma once

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/detail/cdr_reader.hpp"
#include "roscell/ros2/detail/cdr_writer.hpp"

/// INTERNAL: for what is made from definitions of messages, which compiles
/// these once for each.
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
