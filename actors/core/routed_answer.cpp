#include "actors/core/routed_answer.hpp"

namespace roscell {

std::optional<failure> refusal_in(const request_routed& answer) {
  if (answer.refusal.empty())
    return std::nullopt;
  const auto text = json::parse(answer.text, nullptr, false);
  if (!text.is_object())
    return failure{error_code_from(answer.refusal), answer.refusal};
  return failure_from(text);
}

} // namespace roscell
