#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/error_code.hpp"

#include <caf/error.hpp>
#include <caf/make_message.hpp>

#include <string>

namespace roscell {

/// Why a request was refused, in words for its sender.
/// JSON form: schemas/error.schema.json.
struct failure {
  error_code code = error_code::internal;
  std::string message; ///< What is wrong, one sentence.
  std::string where;   ///< JSON pointer into the request, may be empty.
  std::string hint;    ///< What to do about it, may be empty.
  std::string details; ///< JSON object merged into `error`, may be empty.

  static constexpr auto fields() {
    return field_list{required("code", &failure::code),
                      required("message", &failure::message),
                      required("where", &failure::where),
                      required("hint", &failure::hint),
                      raw_json("details", &failure::details)};
  }
};

void to_json(json& j, error_code code);
void from_json(const json& j, error_code& code);

/// `{"type":"error","error":{...}}`, with the details merged into `error`.
json error_reply(const failure& why);

/// The failure that an error reply tells of; `internal` when it is none.
failure failure_from(const json& reply);

/// A failure as an actor's error, and back. An error of CAF itself (a
/// timeout, a receiver that is gone) becomes the matching failure.
caf::error to_error(const failure& why);
failure to_failure(const caf::error& err);

/// Shorthand for `to_error(failure{...})`.
caf::error fail(error_code code, std::string message, std::string where = {},
                std::string hint = {});

} // namespace roscell

CAF_ERROR_CODE_ENUM(roscell::error_code, "roscell")
