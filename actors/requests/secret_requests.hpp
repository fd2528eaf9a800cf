#pragma once

#include "messages/failure.hpp"

#include <optional>
#include <string>

/// What is special about requests that concern secrets: the node that is asked
/// answers them itself, and nothing remembers what they hold.
namespace roscell {

/// Why a request of that type is not taken from whom it comes; none: it is. The
/// value of a secret comes from this host only: from elsewhere it would travel
/// in clear, and the token that comes with it.
/// @param from as in `route_request`.
std::optional<failure> refuse_from_afar(const std::string& type,
                                        const std::string& from);

/// Why no secret is passed on to that node, where sessions have a token.
failure secret_in_clear(const std::string& node);

/// Whether who sends it again gets the same answer: what is remembered for that
/// has all of the request in it.
bool may_be_remembered(const std::string& type);

/// Why a document is no request, without what that quotes of a value.
failure without_value(const json& document, failure why);

} // namespace roscell
