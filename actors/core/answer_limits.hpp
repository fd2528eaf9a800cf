#pragma once

#include "actors/edge/limit_units.hpp"

#include <chrono>
#include <optional>
#include <string_view>

/// How long each waits for an answer that passes through several parts and
/// nodes. Who is farther out waits longer.
namespace roscell::limits {

/// Actors of one node, and the coordinator's answers from what it knows.
namespace local {

/// For a part that only looks at its own state, or at the host.
constexpr seconds part{5};
/// For what may ask one part after another.
constexpr seconds answer{10};

} // namespace local

namespace task {

/// For instances of lower priority to be stop-safe and gone.
constexpr minutes eviction{10};
/// To start an instance: what one node's agent waits for its supervisor,
constexpr milliseconds agent_deployment{11 * 60'000 + 30'000};
/// what the coordinator's end of a session waits for the node,
constexpr milliseconds deployment{12 * 60'000};
/// and who wants the instance to run.
constexpr minutes deployment_answer{13};
/// The same for removal.
constexpr milliseconds agent_removal{48'000};
constexpr milliseconds removal{52'000};
constexpr milliseconds removal_answer{55'000};
/// To terminate a task, with what is written of it.
constexpr seconds termination{80};

} // namespace task

namespace transfer {

/// For a transfer that another coordinator carries out: instances may have to
/// be started elsewhere first.
constexpr milliseconds forwarded = task::deployment + minutes{2};
/// For a node to be let go: what is not stop-safe by then keeps it here.
constexpr milliseconds preparing = task::deployment_answer;
/// What the request for a transfer waits.
constexpr milliseconds answer = forwarded + seconds{30};

} // namespace transfer

namespace request {

/// The router's limit for a handler or a pipeline,
constexpr minutes handler{15};
/// and the HTTP side's for the router.
constexpr minutes router{16};

/// For a coordinator's answer from what it knows that a member passes on: what
/// the coordinator's end of the session waits for it, and the member.
constexpr milliseconds forwarded_query = local::answer + seconds{2};
constexpr milliseconds member_query = forwarded_query + seconds{2};
/// The same for a request that makes the coordinator do something.
constexpr milliseconds forwarded = handler + seconds{15};
constexpr milliseconds member_request = forwarded + seconds{15};

} // namespace request

/// Logs of instances. Each holds beyond what the query wants to wait, and who
/// is farther from the instance has more.
namespace log {

/// The longest wait that a query may ask for (messages/instance.hpp).
constexpr milliseconds wait{20'000};

constexpr seconds runtime{5};
constexpr seconds agent{6};
constexpr seconds session{10};
constexpr seconds coordinator{12};
constexpr seconds answer{14};
constexpr seconds stream{60};

} // namespace log

} // namespace roscell::limits

namespace roscell {

/// How long a node has for a request that it answers about itself, and that
/// another node of its cell may send it by their coordinator; none for others.
std::optional<std::chrono::milliseconds> relayed_limit(std::string_view type);

/// What each hop on the way adds to that.
constexpr std::chrono::seconds relay_margin{2};

} // namespace roscell
