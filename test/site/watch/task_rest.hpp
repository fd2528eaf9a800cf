#pragma once

#include "test/site/site.hpp"

#include <string>

namespace roscell::test {

/// What of tasks is not as it shall be once things have calmed down, for
/// people; empty if all is well.
std::string task_complaint(const site& place);

/// Ends every task, and says what is left of them: programs, records, room.
std::string end_all_tasks(site& place);

} // namespace roscell::test
