#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <cstdint>
#include <string>

namespace roscell::cli {

/// What skills ask for, so that a whole image finds room
/// (skills/ros2/participant_qos.cpp).
constexpr int64_t wanted_buffer_bytes = 8L * 1024 * 1024;

/// What the kernel gives a socket that asks for `wanted_buffer_bytes`.
struct buffer_readings {
  int64_t receive = 0;
  int64_t send = 0;
};

buffer_readings read_buffers();

/// What has to find room.
struct sent_image {
  std::string name; ///< "an image of 1280x960 in colour"
  int64_t bytes = 0;
};

sent_image image_of(int64_t width, int64_t height);

/// For a host of which it is not known what flows.
sent_image usual_image();

finding judge_buffers(const buffer_readings& given,
                      const sent_image& image = usual_image());

findings check_buffers(const checked_host& host);

} // namespace roscell::cli
