#pragma once

#include "messages/codec/json_codec.hpp"

#include <caf/error.hpp>
#include <caf/make_message.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace roscell {

/// Everything that a request can be refused for. The words are part of the
/// wire protocol (docs/protocols.md): append, never rename.
enum class error_code : uint8_t {
  malformed_json = 1,     ///< The text is not JSON, or too large or deep.
  unknown_type,           ///< No pipeline or handler takes this `type`.
  schema_violation,       ///< The document breaks its JSON Schema.
  unknown_node,           ///< No node of that name is in this cell.
  unknown_cell,           ///< No coordinator of that cell is visible.
  unknown_task,           ///< No task or instance of that id is known.
  task_exists,            ///< The task id is in use by another body.
  unknown_operation,      ///< No skill of the cell has this operation.
  unknown_model,          ///< The skill has no such implementation model.
  unknown_deployment,     ///< The model has no such deployment option.
  no_feasible_allocation, ///< No placement satisfies every constraint.
  conflict,               ///< The state of the subject forbids it now.
  engine_failed,          ///< An instance did not come up, or broke.
  unreachable,            ///< The peer cannot be reached.
  timeout,                ///< No answer within the time limit.
  unauthorized,           ///< The token is missing or wrong.
  unresolved,             ///< The outcome cannot be known in time.
  internal,               ///< A defect of this program.
};

std::string_view to_word(error_code code);

/// The code whose word is `word`; `error_code::internal` for any other text.
error_code error_code_from(std::string_view word);

std::string to_string(error_code code);

} // namespace roscell

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
