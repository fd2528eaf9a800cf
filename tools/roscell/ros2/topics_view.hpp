#pragma once

#include "messages/topic.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>

namespace roscell::cli {

/// The topics with who is at their ends; below them, what does not match.
std::string topics_view(const topic_list& topics, const view_style& style);

} // namespace roscell::cli
