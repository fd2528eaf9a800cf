#include "tools/roscell/doctor/node/asked_nodes.hpp"

#include "messages/failure.hpp"
#include "tools/roscell/exit_code.hpp"

namespace roscell::cli {

finding finding_of_failure(const std::exception& why, judgement how) {
  if (const auto* x = dynamic_cast<const refused*>(&why)) {
    const auto reported = failure_from(x->reply);
    return {how, reported.message, reported.hint};
  }
  if (const auto* x = dynamic_cast<const command_error*>(&why))
    return {how, x->what(), x->hint};
  return {how, std::string{"the answer is not understood: "} + why.what(),
          "the node is of another version than this program"};
}

bool cannot_check(const std::exception& why) {
  const auto* reported = dynamic_cast<const refused*>(&why);
  if (reported == nullptr)
    return false;
  const auto code = failure_from(reported->reply).code;
  return code == error_code::unknown_type || code == error_code::conflict;
}

} // namespace roscell::cli
