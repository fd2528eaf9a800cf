#include "actors/core/answer_limits.hpp"
#include "actors/placement/limits.hpp"
#include "actors/requests/handlers/task_pipeline.hpp"

#include <map>
#include <memory>
#include <utility>

namespace roscell {

namespace {

/// One task whose place is held, while others still have to leave it. Lives as
/// long as the requests that hold it.
class preempting : public std::enable_shared_from_this<preempting> {
public:
  preempting(const request_context& context, intended_task task,
             outcome<intended_task> done)
      : context_(context), task_(std::move(task)), done_(std::move(done)) {}

  void begin() {
    auto self = shared_from_this();
    context_.call<instances_preempted>(
        context_.services->coordinator, limits::task::eviction,
        preempt_instances{task_.task, task_.preempted, task_.force},
        [self](const instances_preempted&) { self->reserve(); },
        [self](const caf::error& why) { self->give_up(not_gone(why)); });
  }

private:
  struct request {
    node_agent_actor agent;
    instance_reservation message;
  };

  static failure not_gone(const caf::error& error) {
    auto why = to_failure(error);
    if (why.code == error_code::timeout)
      why = {error_code::timeout,
             "what is to be preempted is not stop-safe yet, or does not end",
             "",
             "`roscell tasks` shows what is waited for; `--force` waits for "
             "nothing"};
    return why;
  }

  /// The members still say whether the room is there: other programs may have
  /// taken it.
  void reserve() {
    std::map<std::string, request> requests;
    for (size_t i = 0; i < task_.specs.size(); ++i) {
      auto& x = requests[task_.nodes[i]];
      x.agent = task_.agents[i];
      x.message.task = task_.task;
      x.message.cpu_floor = task_.cpu_floor;
      x.message.specs.push_back(task_.specs[i]);
    }
    open_ = requests.size();
    for (const auto& [node, x] : requests)
      reserve_on(node, x);
  }

  void reserve_on(const std::string& node, const request& x) {
    auto self = shared_from_this();
    context_.call<instances_reserved>(
        x.agent, limits::task::reservation, x.message,
        [self, node](const instances_reserved& reply) {
          for (const auto& one : reply.refused)
            self->problem_ = "node '" + node
                             + "' has no room although "
                               "others were preempted: "
                             + one.reason;
          self->finish_one();
        },
        [self, node](const caf::error& why) {
          self->problem_ = "node '" + node + "': " + to_failure(why).message;
          self->finish_one();
        },
        node);
  }

  void finish_one() {
    if (--open_ > 0)
      return;
    if (problem_.empty())
      return done_.deliver(std::move(task_));
    give_up({error_code::no_feasible_allocation, problem_, "/pipeline",
             "the nodes' resources change; send the request again"});
  }

  void give_up(failure why) {
    undo_placement(
        context_, task_.task, std::move(why),
        [self = shared_from_this()](const failure& x) { self->done_.fail(x); });
  }

  request_context context_;
  intended_task task_;
  outcome<intended_task> done_;
  size_t open_ = 0;
  std::string problem_; ///< The last one; empty: all have room.
};

} // namespace

void have_instances_preempted(const request_context& context,
                              intended_task task, outcome<intended_task> done) {
  if (task.preempted.empty())
    return done.deliver(std::move(task));
  std::make_shared<preempting>(context, std::move(task), std::move(done))
      ->begin();
}

} // namespace roscell
