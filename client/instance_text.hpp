#pragma once

#include "messages/cell.hpp"
#include "messages/step_end.hpp"

#include <cstdint>
#include <string>

/// What several tables say of an instance, each in a cell.
namespace roscell {

/// Its node is away, so nobody knows what has become of it.
bool is_unknown(const instance_row& row);

/// What a node that is away runs is not known, whatever it ran before.
std::string state_text(const instance_row& row);

/// Nothing need be said of it: it runs, with what it needs, and gives
/// something.
bool runs_well(const instance_row& row);

/// For how long it has been so, or has not been known.
std::string since_text(const instance_row& row, int64_t now_unix_ms);

/// "waits to be stop-safe, 12 s; it ends in 48 s all the same".
std::string not_stop_safe_text(const instance_row& row, int64_t now_unix_ms);

/// Whether its skill says that it may be ended; empty: it need not say so.
std::string safety_text(const instance_row& row);

/// What stands behind an instance's state: why it is not known at present, why
/// it ended, for what it waits, or what it says.
std::string remark(const instance_row& row, int64_t now_unix_ms);

/// What one end of a stream does: "10 Hz, 118 frames, 3 failed, 0.85 ms";
/// empty for null.
std::string stream_text(const stream_count* count);

/// What each stream does: "in /image 10 Hz, 118 frames; out /tf 10 Hz, ...".
std::string streams_text(const instance_row& row);

/// What it takes of its host, and what it may or has asked for: "61 MiB of 64
/// MiB", "0.35 of 0.5"; empty: not known.
std::string memory_text(const instance_row& row);
std::string cpu_text(const instance_row& row);

/// It takes more memory than it has asked for, or nearly all that it may.
bool takes_too_much(const instance_row& row);

/// Nothing for a negative value, which is not known.
std::string number_with_unit(double value, int decimals, const char* unit);
std::string count_text(int64_t count);

} // namespace roscell
