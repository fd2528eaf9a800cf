#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Commands that run beside instances.
namespace roscell::limits::exec {

/// On a node, at a time: each costs two processes and six descriptors.
constexpr size_t most = 8;
/// Of all words of a command; the kernel takes no longer word.
constexpr size_t command_bytes = 128 * kib;
/// Input in one request, and output in one answer: in base64 a sixth of a frame
/// between nodes.
constexpr size_t part_bytes = 128 * kib;
/// Output that waits for who reads it; then its program waits too.
constexpr size_t waiting_bytes = 256 * kib;
/// The longest wait of a question for output, or of input for its program, and
/// (messages/exec.hpp) what a question may ask for.
constexpr milliseconds wait{5000};
/// A command of which nobody has asked for anything for so long is ended: who
/// has begun it is gone, or cut off.
constexpr seconds lease{15};
/// For an engine to begin a command, or to say how it has ended.
constexpr seconds engine{10};
/// An engine may take a command for running for a moment after its end.
constexpr milliseconds look_again{50};
constexpr int most_looks = 40;
constexpr int most_instance_looks = 10;
/// After the end of a program, for streams that something else still holds.
constexpr milliseconds last_output{500};

} // namespace roscell::limits::exec
