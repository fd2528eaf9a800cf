#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// One skill instance, from intent to end, and the folders of skills.
namespace roscell::limits {

namespace instance {

/// Live ones on a node. Each costs a shim and three descriptors.
constexpr size_t most = 256;
/// Ended ones whose rows and logs stay until their task is removed.
constexpr size_t most_ended = 32;
/// Rows of older ones that stay until the coordinator keeps that they have
/// ended, or their task is removed: it must not take them for lost and start
/// them again. They are part of a registration, which is one frame.
constexpr size_t most_unacknowledged_bytes = 256 * kib;

/// An actor that dies more often than this will not do better next time.
constexpr int most_deaths = 5;
/// For one record on a slow disk, and for reading the end of a log.
constexpr seconds disk{10};
/// A container engine may have to fetch a base image of some GiB.
constexpr minutes build{10};
/// From the runtime's "start" to its answer.
constexpr seconds start{30};
/// From the start of the program to READY=1; loading a model takes a while.
constexpr seconds ready{30};
/// For its secrets to be laid out, after others that are being written.
constexpr seconds secrets{5};
/// All of it.
constexpr seconds deployment = build + secrets + start + ready + 2 * disk;
/// From the polite request to end to force.
constexpr seconds stop_grace{5};
/// The longest that a runtime can be told to grant.
constexpr milliseconds most_stop_grace{60'000};
/// From one stage of force to the next, for processes.
constexpr seconds force_interval{2};
/// For an engine to kill what does not obey.
constexpr seconds force{10};
/// Beyond the grace; must exceed the runtime's stages of force.
constexpr seconds stop{15};
/// For what an instance left.
constexpr seconds cleaning{15};
/// All of it.
constexpr seconds removal = stop_grace + stop + cleaning + disk;

/// Silence after which a running skill is taken for hung.
constexpr seconds watchdog{10};

/// What skills are told of it. They say that they are alive twice in this time,
/// so after a lost word the next one still comes before they are judged.
constexpr seconds announced_watchdog{8};

/// For a program that runs to take other parameters, between two frames,
constexpr seconds parameter_answer{5};
/// and for whoever asks its instance to have it do so.
constexpr seconds parameters{6};

/// For the cell to carry out what a program asks for itself, on whichever
/// node its coordinator is.
constexpr seconds parameter_request{20};

/// An alarm that comes later than this tells of a pause of our own process.
constexpr seconds pause_tolerance{2};

/// For the first word of a skill after such a pause.
constexpr seconds pause_grace{5};

/// For the runtime to read a socket. One that does not answer in time says
/// nothing of the skill, and is asked again.
constexpr seconds hearing{10};

/// Most of the log's end that goes along with a failure.
constexpr size_t log_tail_bytes = 8 * kib;
/// Earlier ends that are kept of an instance, and of each of their logs so many
/// lines and bytes: they travel with every change of it.
constexpr size_t kept_ends = 5;
constexpr size_t end_lines = 5;
constexpr size_t end_log_bytes = kib;
/// Between two new starts in a row, whatever the policy says: each costs a
/// process and a write.
constexpr milliseconds least_pause{100};
/// For a shim to say that its program runs.
constexpr seconds shim{5};

} // namespace instance

namespace history {

/// For the list of all kept logs of this node.
constexpr seconds list{3};

} // namespace history

/// The folders of skills on a node.
namespace skill {

constexpr size_t most = 1024;
/// Longest descriptor that is read.
constexpr size_t descriptor_bytes = mib;
/// Longest path, which is shown as an instance's image
/// (schemas/common.schema.json).
constexpr size_t path_bytes = 512;
/// Errors of one descriptor that are told.
constexpr size_t errors = 20;

/// Folders that are no skills of which the rest of the cell is told, and the
/// bytes of each text about them.
constexpr size_t published_problems = 32;
constexpr size_t reported_text_bytes = kib;

/// A folder that is being copied is read once nothing has changed for so long,
constexpr milliseconds quiet{300};
/// but folders that never rest keep no other one from being read.
constexpr seconds longest_unrest{5};

} // namespace skill

} // namespace roscell::limits
