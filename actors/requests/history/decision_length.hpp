#pragma once

#include <cstddef>
#include <string>

namespace roscell {

/// Bounds the JSON of a `task_plan` or of an `error`, so that the decision on
/// a large task does not drive out all others: the last of its rejected
/// candidates go, and it says how many. What is no such JSON stays.
void shorten_decision(std::string& text, size_t most_bytes);

} // namespace roscell
