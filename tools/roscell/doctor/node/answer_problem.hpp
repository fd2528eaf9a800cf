#pragma once

#include "tools/roscell/doctor/finding.hpp"

#include <exception>

namespace roscell::cli {

/// Why a question to a node has no answer: it was refused, did not arrive, or
/// the answer is one that this program does not understand.
finding finding_of_failure(const std::exception& why, judgement how);

} // namespace roscell::cli
