#include "actors/core/answer_limits.hpp"
#include "actors/core/wall_clock.hpp"
#include "actors/membership/membership_steps.hpp"

#include <algorithm>

namespace roscell::membership_steps {

namespace {

void stop(self_pointer self, const std::string& instance) {
  auto& st = self->state;
  const auto& rows = *st.instances;
  auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& x) {
    return x.spec.instance == instance;
  });
  if (row == rows.end())
    return;
  self->request(st.parts.agent, limits::task::removal,
                instance_removal{row->spec.task, instance})
      .then([](const instances_removed&) {},
            [self](const caf::error& why) {
              self->state.problem = to_failure(why).message;
            });
}

/// The coordinator counts on this instance: it must hear that it failed also
/// when there never was one that could tell of itself.
void on_start_failed(self_pointer self, const instance_spec& spec,
                     const caf::error& why) {
  auto& st = self->state;
  instance_changed event;
  event.instance.spec = spec;
  event.instance.state = instance_state::failed;
  event.instance.since_unix_ms = unix_now_ms();
  event.instance.reason = to_failure(why).message;
  if (st.phase == membership_phase::joined)
    notify(self, event);
}

void start(self_pointer self, const instance_spec& spec) {
  self->request(self->state.parts.agent, limits::task::deployment,
                instance_deployment{spec})
      .then([](const instance_deployed&) {},
            [self, spec](const caf::error& why) {
              on_start_failed(self, spec, why);
            });
}

} // namespace

void apply(self_pointer self, const std::vector<instance_verdict>& verdicts) {
  for (const auto& x : verdicts) {
    if (x.what == verdict::stop)
      stop(self, x.instance);
    else if (x.what == verdict::start && !x.spec.empty())
      start(self, x.spec.front());
  }
}

} // namespace roscell::membership_steps
