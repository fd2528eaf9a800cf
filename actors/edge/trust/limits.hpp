#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>
#include <cstdint>

/// Certificates, invitations and the list of the revoked.
namespace roscell::limits::trust {

/// Most of what is read of a key, of one certificate, and of a file with both.
constexpr size_t key_bytes = 4 * kib;
constexpr size_t certificate_bytes = 8 * kib;
constexpr size_t identity_bytes = 64 * kib;

/// One's own, and that of the issuer who has signed it.
constexpr size_t chain = 2;

constexpr int64_t day_s = 86'400;
constexpr int64_t year_s = 366 * day_s;
/// How long certificates are good: of the site itself, of an issuer, of nodes
/// and coordinators, and of people.
constexpr int64_t site_s = 20 * year_s;
constexpr int64_t issuer_s = 5 * year_s;
constexpr int64_t machine_s = 180 * day_s;
constexpr int64_t person_s = year_s;
/// They begin so much earlier, for clocks that are behind.
constexpr int64_t early_s = day_s;
/// After its end a certificate is good for its own renewal, and nothing else.
constexpr int64_t renewal_s = 2 * year_s;

/// The thread that computes handshakes ends when it had nothing to do for so
/// long.
constexpr seconds idle_thread{10};
/// Handshakes that a server has begun with at a time, in all and with one
/// address, and for how long.
constexpr size_t handshakes = 8;
constexpr size_t handshakes_of_one = 2;
constexpr seconds handshake{10};

/// Invitations of a coordinator that are open at a time, and for how long.
constexpr size_t invitations = 256;
constexpr seconds invitation{24 * 60 * 60};
constexpr size_t invitation_bytes = 512;
/// Longest answer to one who comes with an invitation.
constexpr size_t admission_bytes = 1024 * kib;

/// Nodes that a coordinator can have made identities for, and their file.
constexpr size_t issued = 4096;
constexpr size_t issued_bytes = 1024 * kib;

/// Certificates that a site can have revoked. Those that have ended for good
/// make room.
constexpr size_t revoked = 4096;
constexpr size_t revocations_bytes = 512 * kib;

} // namespace roscell::limits::trust
