#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace roscell::engine {

/// One unit of data on its way through a skill: a line, an image, a message.
struct frame {
  /// The data itself, as bytes in the representation that `data_type` names.
  std::string payload;
  /// A media type or ROS type name, e.g. `text/plain`. In an emitted frame it
  /// may be left empty: then it is the data type of the output.
  std::string data_type;
  /// What a person would call this frame, e.g. the file's name. In an emitted
  /// frame it may be left empty: then it is derived from the input's name.
  std::string name;
  /// When the data came to be, by the clock of its source, as far as the
  /// protocol knows it. In an emitted
  /// frame it may be left alone: then it is the input's time.
  std::chrono::system_clock::time_point time{};
  /// Counts the frames of a port from 0. Set by the engine.
  std::uint64_t sequence = 0;
  /// The input port the frame came from. Set by the engine.
  std::size_t port = 0;
};

} // namespace roscell::engine
