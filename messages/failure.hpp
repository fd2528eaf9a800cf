#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/error_code.hpp"

#include <caf/error.hpp>
#include <caf/make_message.hpp>

#include <functional>
#include <optional>
#include <string>
#include <utility>

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

/// Whether something has been done, or why it has not: an `expected<void>`
/// whose error is a failure. A continuation that takes one is called once.
class [[nodiscard]] completion {
public:
  /// It has been done.
  completion() = default;

  completion(failure why) : why_{std::move(why)} {}

  /// @param why none: it has been done.
  completion(std::optional<failure> why) : why_{std::move(why)} {}

  explicit operator bool() const {
    return !why_;
  }

  /// Only where it has not been done.
  const failure& error() const {
    return *why_;
  }

private:
  std::optional<failure> why_;
};

using completion_handler = std::function<void(const completion&)>;

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
