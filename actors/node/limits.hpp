#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// One node: its parts, its database, its events.
namespace roscell::limits {

namespace store {

/// Records that wait in memory for room on the disk; who brings one more is
/// refused. Some for each instance, and two for the node itself.
constexpr size_t waiting = 1024;

} // namespace store

namespace resource {

/// A coordinator hears the heartbeats of many members; one sample serves for
/// all. A little shorter than the pause between the heartbeats of one member.
constexpr milliseconds mark_distance{3500};

} // namespace resource

namespace membership {

/// What a node that ends waits for its membership to have left.
constexpr seconds leaving{3};
/// From the signal to the process's end: systemd would wait 90 s before it uses
/// force.
constexpr seconds stopping{5};

} // namespace membership

namespace task {

/// How long a node keeps room for a task at most.
constexpr minutes longest_reservation{1};

} // namespace task

namespace token {

/// At its start a coordinator asks those that claim to be what it is for a
/// proof: so many at once, for so long at most. Who is silent has none.
constexpr size_t claims = 64;
constexpr milliseconds claim_proof{1500};

} // namespace token

/// The node's events.
namespace event {

/// How many are in memory, for a listener that comes late.
constexpr size_t kept = 1000;
/// Refusals of one kind that are told one by one in this time; those beyond
/// are counted. Whoever provokes them without end adds six events a minute.
constexpr size_t refusals = 5;
constexpr seconds refusal_window{60};
/// What happens to one instance or task again and again is kept so often in
/// this time, and then counted: told after such a time, then after times each
/// twice the one before.
constexpr size_t repetitions = 10;
constexpr seconds repetition_window{60};
constexpr minutes longest_repetition_window{60};
/// Series that are looked at; what is beyond them is kept one by one.
constexpr size_t series = 1024;

} // namespace event

namespace history {

/// Events are written together: those of so much time, or so many. A loss of
/// power takes no more. In between they are in memory, with those kept there.
constexpr seconds batch_span{20};
constexpr size_t batch = 256;
/// For a batch of events on a slow disk, and for a part of the past.
constexpr seconds disk{8};
/// For the last batch, as a node that ends has `membership::stopping` for all.
constexpr seconds last_batch{2};

} // namespace history

namespace discovery {

/// For the coordinators of the site to be seen at the start.
constexpr milliseconds survey{60};
/// The same where somebody has claimed a name that is not his: its owner may be
/// slower, on a busy host or a long way.
constexpr milliseconds second_survey{500};

} // namespace discovery

} // namespace roscell::limits
