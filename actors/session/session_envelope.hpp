#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "messages/inside/requests.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// The frames that pass between a member and its coordinator, as text.
namespace roscell {

enum class envelope_kind { request, reply, notice };

/// A frame that came in. Its body has passed its schema unless `refused`.
struct session_envelope {
  envelope_kind kind = envelope_kind::notice;
  uint64_t id = 0; ///< Of a request or reply.
  json body;
  std::optional<failure> refused; ///< What is wrong with the body.
};

/// Reads one frame. Nothing when not even the envelope can be read, and so
/// nobody can be told.
std::optional<session_envelope> read_envelope(std::string_view text);

/// The body of a frame that answers what the request router has answered, or
/// says that it is too large for one.
json body_of(const request_routed& answer);

/// The text of a frame. `id` is of no interest to a notice.
std::string write_envelope(envelope_kind kind, uint64_t id, json body);

} // namespace roscell
