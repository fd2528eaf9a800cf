#pragma once

#include "tools/roscell/doctor/examined_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <cstdint>

namespace roscell::cli {

/// What skills ask for, so that a whole image finds room
/// (skills/ros2/participant_qos.cpp).
constexpr int64_t wanted_buffer_bytes = 8L * 1024 * 1024;

/// What the kernel gives a socket that asks for `wanted_buffer_bytes`.
struct buffer_facts {
  int64_t receive = 0;
  int64_t send = 0;
};

buffer_facts look_at_buffers();

finding judge_buffers(const buffer_facts& given);

findings examine_buffers(const examined_host& host);

} // namespace roscell::cli
