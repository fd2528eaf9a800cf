#pragma once

#include <chrono>
#include <cstdint>

/// How long the two sides of a session wait. The node gives up its own parts a
/// little before the coordinator gives up the node, so that the coordinator
/// hears why.
namespace roscell {

using session_duration = std::chrono::milliseconds;

/// By which the node is earlier.
constexpr session_duration answer_margin{2000};

/// A measurement that has no CPU sample yet takes a second.
constexpr session_duration resource_query_timeout{6000};

/// An image may have to be built first, then the program starts: longer than
/// the limits of a skill instance together.
constexpr session_duration deployment_timeout{12 * 60'000};

/// Instances are given 5 s to end by themselves.
constexpr session_duration removal_timeout{30'000};

/// On top of what a log query wants to wait.
constexpr session_duration log_query_timeout{10'000};

/// The longest wait that a log query may ask for.
constexpr session_duration max_log_wait{20'000};

/// From the session's start to the registration.
constexpr session_duration registration_limit{15'000};

/// From the registration to its answer. Shorter than a lease: a registry must
/// not show for longer a member that does not know that it is one.
constexpr session_duration registration_timeout{5000};

/// What the coordinator has for it, so that the node hears the outcome.
constexpr session_duration row_timeout{4000};

/// For a place: the coordinator that hands them out may be another one, and a
/// third one has to keep it.
constexpr session_duration place_timeout{8000};

/// How long one coordinator waits for another one.
constexpr session_duration peer_timeout{3000};

/// For a transfer that another coordinator carries out: instances may have to
/// be started elsewhere first.
constexpr session_duration transfer_timeout =
    deployment_timeout + session_duration{2 * 60'000};

/// For a switch to be written down.
constexpr session_duration switch_timeout{6000};

/// How long a node that leaves waits for the coordinator to know.
constexpr session_duration departure_timeout{2000};

} // namespace roscell
