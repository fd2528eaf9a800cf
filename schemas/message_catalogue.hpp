#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "schemas/validator.hpp"

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Which messages there are, and the check that every edge makes with them.
namespace roscell {

enum class message_kind {
  request,   ///< Sent to a node or coordinator by a user.
  reply,     ///< Answers a request; `error` among them.
  session,   ///< Between a member and its coordinator.
  handshake, ///< The frames that open a session.
  event,     ///< A line of the event stream.
  document,  ///< A file, without a "type".
  part,      ///< What the schemas have in common.
};

constexpr auto enum_words(message_kind) {
  return std::array<std::string_view, 7>{
      "request", "reply", "session", "handshake", "event", "document", "part"};
}

struct message_type {
  std::string_view name;
  message_kind kind;
  std::string_view reply; ///< The type that answers it; empty: none.
};

/// Every schema of the project, sorted by name.
const std::vector<message_type>& message_types();

/// The type of that name, or null.
const message_type* find_message_type(std::string_view name);

/// Checks a message from outside: that it is an object whose "type" is known
/// and of one of the `allowed` kinds (none given: any that has a type), then
/// the type's schema and semantic rules. Of an envelope (`session_request`,
/// ...) the body is only known to have a "type": check it by a call of its own.
///
/// Errors: unknown_type, schema_violation with every violation.
std::optional<failure>
validate_message(const json& message,
                 std::initializer_list<message_kind> allowed = {});

/// As `validate_message` for what a user sends, who is no newer peer: a member
/// that the schema does not describe is a violation, too.
std::optional<failure> validate_request(const json& message);

/// Every violation of the schema of that name and of its semantic rules.
std::vector<schema_error> document_errors(std::string_view schema,
                                          const json& document,
                                          unknown_members others);

/// As `validate_request`, for a document without a "type": `skill_descriptor`,
/// `plan_document`. Errors: schema_violation.
std::optional<failure> validate_document(std::string_view schema,
                                         const json& document);

} // namespace roscell
