#pragma once

#include "actors/requests/request_context.hpp"
#include "messages/failure.hpp"

#include <functional>
#include <variant>

namespace roscell {

/// Asks the coordinator of a member what the node itself does not know. What it
/// has refused for another reason, and what nobody of the cell knows, ends in
/// the node's own refusal.
/// @param known the node's own refusal.
/// @param done called once, with the reply or the refusal.
void ask_coordinator(const request_context& context, const json& request,
                     const failure& known,
                     std::function<void(std::variant<json, failure>)> done);

} // namespace roscell
