#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/trust/identity.hpp"
#include "messages/failure.hpp"

#include <optional>
#include <string_view>

/// Who may ask what over TCP, by the role of his identity. Whoever opens the
/// Unix socket has none, and may all.
///
///     operator     all but what only coordinators say to nodes
///     viewer       what shows: no change, no log or build, no command's output
///     node         who a node is and where it stands; what it has a permit for
///     coordinator  that, and to switch a node's registration
///     newcomer     POST below /v1/site, which nobody else may
namespace roscell {

/// Whether the role may use this method on this path.
bool may_use_path(site_role role, std::string_view method,
                  std::string_view path);

/// Whether the role may send this request to `/v1/requests`.
bool may_request(site_role role, std::string_view type);

/// Why an HTTP request is refused by its role and path; none: it is not.
std::optional<failure> refuse_by_role(const http_request& request);

/// The same for a request of that type, by somebody of this role; an empty one
/// is trusted with all but what is for newcomers alone: what they say is
/// completed where they come in, by what nobody else has. None too for one that
/// says no type, and is refused for that.
std::optional<failure> refuse_by_type(const std::string& role,
                                      const std::string& type);

} // namespace roscell
