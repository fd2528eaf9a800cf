#include "actors/cell/cell_questions.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/session/limits.hpp"
#include "messages/failure.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

namespace roscell {

namespace {

using log_promise = caf::typed_response_promise<log_excerpt>;

struct log_tally : open_questions {
  kept_logs found;
};

/// The newest of all nodes.
void put_in_order(kept_logs& found) {
  auto& logs = found.logs;
  std::stable_sort(logs.begin(), logs.end(),
                   [](const kept_log& x, const kept_log& y) {
                     return y.ended_unix_ms < x.ended_unix_ms;
                   });
  if (logs.size() > limits::history::listed_logs)
    logs.resize(limits::history::listed_logs);
}

void ask_for_logs(coordinator_pointer self, const std::string& node,
                  const kept_logs_query& query,
                  const std::shared_ptr<log_tally>& tally) {
  const auto* entry = self->state.registry.find_name(node);
  if (entry == nullptr || !entry->agent) {
    tally->found.silent.push_back(node);
    return;
  }
  ++tally->open;
  self->request(entry->agent, limits::history::cell_list, query)
      .then(
          [=](kept_logs& x) {
            auto& logs = tally->found.logs;
            std::move(x.logs.begin(), x.logs.end(), std::back_inserter(logs));
            tally->found.unreadable += x.unreadable;
            tally->finish_one();
          },
          [=](const caf::error&) {
            tally->found.silent.push_back(node);
            tally->finish_one();
          });
}

void ask_all_for_logs(coordinator_pointer self, const kept_logs_query& query,
                      std::function<void(kept_logs)> on_all) {
  auto tally = std::make_shared<log_tally>();
  tally->on_all = [known = tally.get(), on_all = std::move(on_all)] {
    put_in_order(known->found);
    on_all(std::move(known->found));
  };
  for (const auto& row : self->state.registry.rows())
    ask_for_logs(self, row.identity.name, query, tally);
  tally->finish_one();
}

void ask_node_for_log(coordinator_pointer self, const std::string& node,
                      const log_query& query, std::chrono::milliseconds limit,
                      log_promise promise) {
  const auto* entry = self->state.registry.find_name(node);
  if (entry == nullptr || !entry->agent) {
    promise.deliver(fail(error_code::unreachable,
                         "node '" + node + "', which has the log, is away",
                         "/instance",
                         "try again when `roscell nodes` shows it active"));
    return;
  }
  self->request(entry->agent, limit, query)
      .then(
          [promise](log_excerpt& x) mutable { promise.deliver(std::move(x)); },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
}

/// Nothing more comes to a log that is kept, so nobody waits for it.
void fetch_kept_log(coordinator_pointer self, const log_query& query,
                    log_promise promise) {
  constexpr auto limit = limits::history::member_list;
  auto request = query;
  request.previous = true;
  request.wait_ms = 0;
  const auto node = std::exchange(request.node, {});
  if (!node.empty())
    return ask_node_for_log(self, node, request, limit, promise);
  ask_all_for_logs(
      self, {query.instance, {}}, [=](const kept_logs& known) mutable {
        if (known.logs.empty())
          promise.deliver(unknown_thing("instance", query.instance));
        else
          ask_node_for_log(self, known.logs.front().node, request, limit,
                           promise);
      });
}

} // namespace

caf::result<log_excerpt> fetch_log(coordinator_pointer self,
                                   const log_query& query) {
  auto promise = self->make_response_promise<log_excerpt>();
  const auto instance = self->state.deployments.find_row(query.instance);
  if (query.previous || !instance)
    fetch_kept_log(self, query, promise);
  else
    ask_node_for_log(self, instance->node, query,
                     limits::log::coordinator
                         + std::chrono::milliseconds{query.wait_ms},
                     promise);
  return promise;
}

caf::result<kept_logs> collect_kept_logs(coordinator_pointer self,
                                         const kept_logs_query& query) {
  auto promise = self->make_response_promise<kept_logs>();
  ask_all_for_logs(self, query, [promise](kept_logs x) mutable {
    promise.deliver(std::move(x));
  });
  return promise;
}

} // namespace roscell
