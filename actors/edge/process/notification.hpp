#pragma once

#include "messages/instance.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// What a program said in the protocol of sd_notify(3).
struct notification {
  bool ready = false;                 ///< READY=1
  bool alive = false;                 ///< WATCHDOG=1
  bool stopping = false;              ///< STOPPING=1
  std::string status;                 ///< STATUS=, one line of valid UTF-8.
  safe_word safe = safe_word::untold; ///< ROSCELL_SAFE=0 or 1
  /// ROSCELL_STREAMS=, what its data streams do: "END RATE AGE" for each,
  /// separated by ";". END is "input:N" or "output:N", RATE in Hz, AGE in
  /// seconds, or "-" where there was no frame yet.
  std::vector<stream_metrics> streams;
  /// ROSCELL_FRAMES=, what has gone through its data streams, whole numbers
  /// separated by ";": "input:N RECEIVED PROCESSED FAILED DROPPED MEDIAN_US"
  /// and "output:N WRITTEN". It goes along with a status, as does
  /// ROSCELL_REMARK=, why nothing comes of its frames.
  std::vector<stream_count> frames;
  std::string remark;
  /// ROSCELL_PARAMETERS_TAKEN=, the number of a change of parameters that the
  /// program works with now; 0: not said.
  int64_t parameters_taken = 0;
  /// ROSCELL_PARAMETERS_REFUSED=, the number of one that it does not take, and
  /// after a blank why, in a sentence.
  int64_t parameters_refused = 0;
  std::string refusal;
  /// ROSCELL_PARAMETERS_WANTED=, the number of a request for other
  /// parameters, and after a blank a JSON object of those that change.
  int64_t parameters_wanted = 0;
  std::string wanted_parameters;
};

/// Longest datagram that is read; longer ones are ignored whole.
constexpr size_t max_notification_bytes = 4096;

/// Longest status that is kept, in bytes: all metrics of a skill, however
/// large.
constexpr size_t max_status_bytes = 512;

/// Longest remark that is kept, in bytes.
constexpr size_t max_remark_bytes = 256;

/// Longest refusal that is kept, in bytes.
constexpr size_t max_refusal_bytes = 512;

/// A line that tells of more streams is ignored: a step has at most 16 inputs
/// and as many outputs.
constexpr size_t max_reported_streams = 32;

/// Reads one datagram. Unknown and malformed lines are ignored, for programs
/// may say more than we understand.
notification parse_notification(std::string_view datagram);

/// Adds what was said later to what was said before.
void merge(notification& before, notification later);

/// Reads what follows ROSCELL_STREAMS=, see `notification`. Empty when a part
/// of it makes no sense: of a line that is broken no value can be trusted.
std::vector<stream_metrics> read_streams(std::string_view text);

/// Reads what follows ROSCELL_FRAMES=, in the same way.
std::vector<stream_count> read_frames(std::string_view text);

} // namespace roscell
