#include "actors/requests/handlers/host_checking.hpp"

#include "actors/core/relayed_requests.hpp"

#include <atomic>
#include <utility>

namespace roscell {

namespace {

struct examiner_state {
  static constexpr const char* name = "examiner";
};

using examiner_self = examiner_actor::stateful_pointer<examiner_state>;

/// Ends with its answer.
examiner_actor::behavior_type
examiner(examiner_self self, const std::shared_ptr<const node_services>& home) {
  return {
      [](const state_query&) {
        return state_of({{"looking", true}});
      },
      [self, home](const examination_query&) -> caf::result<examination> {
        self->quit();
        auto found = home->check_host();
        if (found.empty())
          return fail(error_code::conflict,
                      "node '" + home->name + "' is checking already", "",
                      "ask again in a few seconds");
        return examination{home->name, std::move(found)};
      },
  };
}

} // namespace

void check_host(const request_context& context, examination_query query,
                outcome<examination> done) {
  const auto& home = context.services;
  if (!home->check_host)
    return done.fail(failure{error_code::conflict,
                             "the program of node '" + home->name
                                 + "' cannot check its host",
                             "", "run `roscell doctor` there"});
  const auto looks =
      spawn_blocking(context.self->system(), context.home(), examiner, home);
  ask<examination>(context, looks, *relayed_limit(examination_query::type),
                   std::move(query), done,
                   [done](examination x) { done.deliver(std::move(x)); });
}

std::function<findings()> one_at_a_time(std::function<findings()> look) {
  if (!look)
    return nullptr;
  return [look = std::move(look),
          busy = std::make_shared<std::atomic<bool>>(false)] {
    if (busy->exchange(true))
      return findings{};
    // Also when it throws: a look that fails once must not be the last one.
    const auto done = [](std::atomic<bool>* x) { *x = false; };
    const std::unique_ptr<std::atomic<bool>, decltype(done)> end{busy.get(),
                                                                 done};
    return look();
  };
}

} // namespace roscell
