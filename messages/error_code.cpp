#include "messages/error_code.hpp"

#include <array>

namespace roscell {

namespace {

/// In the order of `error_code`, which starts at 1.
constexpr std::array<std::string_view, 18> words{
    "malformed_json",
    "unknown_type",
    "schema_violation",
    "unknown_node",
    "unknown_cell",
    "unknown_task",
    "task_exists",
    "unknown_operation",
    "unknown_model",
    "unknown_deployment",
    "no_feasible_allocation",
    "conflict",
    "engine_failed",
    "unreachable",
    "timeout",
    "unauthorized",
    "unresolved",
    "internal",
};

} // namespace

std::string_view to_word(error_code code) {
  return words.at(static_cast<size_t>(code) - 1);
}

error_code error_code_from(std::string_view word) {
  for (size_t i = 0; i < words.size(); ++i)
    if (words[i] == word)
      return static_cast<error_code>(i + 1);
  return error_code::internal;
}

std::string to_string(error_code code) {
  return std::string{to_word(code)};
}

} // namespace roscell
