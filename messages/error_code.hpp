#pragma once

#include <cstdint>
#include <string>
#include <string_view>

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
