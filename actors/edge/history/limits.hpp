#pragma once

#include "actors/edge/limit_units.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>

/// What a node keeps on its disk of what was said: events, and logs of
/// instances that are gone.
namespace roscell::limits {

namespace history {

/// All of it; `--history-bytes` and `--history-age` set others.
constexpr size_t bytes = 64 * mib;
constexpr std::chrono::hours age{7 * 24};
/// A file of events that is larger, or older, gets no more of them: it goes as
/// a whole. At most as many files as `bytes` holds of them are there.
constexpr size_t file_bytes = mib;
constexpr std::chrono::hours file_age{12};
/// Longest line that is read back; longer ones are not ours.
constexpr size_t line_bytes = 64 * kib;
/// Events and bytes in one part of an answer, and the most that can be asked
/// for as the newest.
constexpr size_t part = 256;
constexpr size_t part_bytes = 256 * kib;
constexpr size_t newest = 10'000;
/// Numbers that are set aside at a time, and when it is done again.
constexpr uint64_t numbers = 4096;
/// The least that may be kept: less could hold not even one file.
constexpr size_t least_bytes = 2 * file_bytes;

/// Logs that are kept at most, however small they are,
constexpr size_t logs = 2000;
/// and of one instance: those of its last runs.
constexpr size_t runs = 3;
/// Logs that are told of at a time (messages/kept_log.hpp).
constexpr size_t listed_logs = 1000;
/// Most bytes of what is noted beside a log.
constexpr size_t about_bytes = 16 * kib;

} // namespace history

/// Who has changed what.
namespace audit {

/// Of each of the two files: some ten thousand records together.
constexpr size_t file_bytes = 2 * mib;
/// Records in one answer.
constexpr size_t newest = 1000;
constexpr size_t text_bytes = 256; ///< Longest text of a record.

} // namespace audit

} // namespace roscell::limits
