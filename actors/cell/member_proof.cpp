#include "actors/cell/member_proof.hpp"

#include "actors/session/limits.hpp"
#include "messages/failure.hpp"

namespace roscell {

namespace {

/// A node on the same site answers within milliseconds, and the one that wants
/// its row waits meanwhile.
constexpr std::chrono::seconds member_proof{1};

static_assert(member_proof < limits::membership::registration);

/// Whoever refuses to answer is there.
bool shows_absence(const caf::error& why) {
  const auto code = to_failure(why).code;
  return code == error_code::timeout || code == error_code::unreachable;
}

} // namespace

void prove_member(coordinator_pointer self, const member_actor& member,
                  const std::function<void(bool is_there)>& then) {
  self->request(member, member_proof, resource_query{})
      .then([then](const resource_report&) { then(true); },
            [then](const caf::error& why) { then(!shows_absence(why)); });
}

} // namespace roscell
