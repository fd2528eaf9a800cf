#include "actors/instances/container_supervisor_steps.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

using log_promise = caf::typed_response_promise<log_excerpt>;

caf::error unknown_instance(const std::string& instance) {
  return fail(error_code::unknown_task,
              "there is no instance '" + instance + "'", "/instance",
              "`roscell instances` lists them");
}

/// `why` says why there is no other log.
void read_kept(container_supervisor_pointer self, const log_query& query,
               log_promise promise, const caf::error& why) {
  const auto& history = self->state.config.history;
  if (!history) {
    promise.deliver(why);
    return;
  }
  self->request(history, limits::log::runtime, query)
      .then(
          [promise](log_excerpt& x) mutable { promise.deliver(std::move(x)); },
          [promise](caf::error& x) mutable { promise.deliver(std::move(x)); });
}

bool is_missing(const caf::error& why) {
  return to_failure(why).code == error_code::unknown_task;
}

} // namespace

caf::result<log_excerpt> read_log(container_supervisor_pointer self,
                                  const log_query& query) {
  auto promise = self->make_response_promise<log_excerpt>();
  if (query.previous || find_instance(self, query.instance) == nullptr) {
    read_kept(self, query, promise, unknown_instance(query.instance));
    return promise;
  }
  // The row of one that has ended outlives its log.
  self->request(self->state.runtime, wait_of(query) + limits::log::runtime,
                query)
      .then([promise](const log_excerpt& x) mutable { promise.deliver(x); },
            [=](const caf::error& why) mutable {
              if (is_missing(why))
                read_kept(self, query, promise, why);
              else
                promise.deliver(why);
            });
  return promise;
}

caf::result<kept_logs> list_logs(container_supervisor_pointer self,
                                 const kept_logs_query& query) {
  const auto& config = self->state.config;
  if (!config.history)
    return kept_logs{};
  auto promise = self->make_response_promise<kept_logs>();
  self->request(config.history, limits::history::list, query)
      .then(
          [promise, node = config.node](kept_logs& x) mutable {
            // The node may have had another name then.
            for (auto& log : x.logs)
              log.node = node;
            promise.deliver(std::move(x));
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

kept_log about_log_of(const supervised_instance& x) {
  auto result = about_log_of(x.row);
  result.started_unix_ms = x.began_unix_ms;
  return result;
}

} // namespace roscell
