#pragma once

#include "messages/codec/json_codec.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace roscell {

/// Times that were noted by another clock than the one they are told by.
struct time_shift {
  int64_t from = 0;  ///< Only what is not before this
  int64_t until = 0; ///< and not after this
  int64_t by = 0;    ///< is later by so much.

  /// A time before 1970 would be none.
  int64_t operator()(int64_t unix_ms) const {
    return unix_ms >= from && unix_ms <= until
               ? std::max<int64_t>(1, unix_ms + by)
               : unix_ms;
  }
};

/// From the time of this node (actors/edge/io/node_time.hpp) to what the wall
/// clock says of it now. A time that is far before this process began is from
/// disk and was told by a wall clock already; one that is nearer to its begin
/// than to what the wall clock says is of a peer.
time_shift to_wall_clock();

/// From the time of a node to that of this one, which is ahead of it by so
/// much. What would be yet to come was noted by yet another clock.
time_shift from_peer(int64_t ahead_ms);

/// Each number whose name ends in "unix_ms", but for the times of files.
void shift_times(json& x, const time_shift& shift);

/// The same in a text. One that is no JSON, and one without such a time, stays
/// as it is, and each one does if nothing is to be shifted.
std::string with_times_shifted(std::string text, const time_shift& shift);

} // namespace roscell
