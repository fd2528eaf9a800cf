#pragma once

#include "schemas/decode.hpp"

#include <string>
#include <utility>
#include <variant>

namespace roscell {

/// What a node has answered at its REST address, or why that is no answer. The
/// address was announced by whoever likes to, so that the text may be anything.
/// Errors: unreachable for what no node of ROSCell says, and the node's own.
std::variant<json, failure> read_answer(const std::string& text);

/// The same as a `Reply`.
template <class Reply>
std::variant<Reply, failure> answer_as(const std::string& text) {
  auto document = read_answer(text);
  if (auto* why = std::get_if<failure>(&document))
    return std::move(*why);
  return decode<Reply>(std::get<json>(document));
}

} // namespace roscell
