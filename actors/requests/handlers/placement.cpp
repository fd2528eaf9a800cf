#include "actors/core/answer_limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/limits.hpp"
#include "actors/requests/handlers/task_pipeline.hpp"
#include "actors/requests/limits.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>

namespace roscell {

namespace {

/// One task on its way to a place where every member keeps room for it. Lives
/// as long as the requests that hold it.
class placing : public std::enable_shared_from_this<placing> {
public:
  placing(const request_context& context, resolved_task task,
          outcome<reserved_task> done)
      : context_(context), task_(std::move(task)), done_(std::move(done)) {}

  void search() {
    allocate_task question{
        task_.request.task, task_.steps, task_.cell.nodes, held_.refused, {}};
    if (task_.request.preempt != preemption::none)
      question.evictable = task_.cell.evictable;
    ask<task_plan>(context_.services->scheduler, limits::task::search,
                   std::move(question),
                   [](placing& self, task_plan& plan) { self.adopt(plan); });
  }

private:
  /// Asks on behalf of the task. A conflict means that a node has left: the
  /// task is placed anew.
  template <class Reply, class Handle, class Message>
  void ask(const Handle& whom, std::chrono::milliseconds timeout,
           Message message, void (*on_reply)(placing&, Reply&)) {
    auto self = shared_from_this();
    context_.call<Reply>(
        whom, timeout, std::move(message),
        [self, on_reply](Reply& x) { on_reply(*self, x); },
        [self](const caf::error& why) { self->on_error(why); });
  }

  void on_error(const caf::error& error) {
    auto why = to_failure(error);
    if (why.code == error_code::conflict)
      return start_again(std::move(why));
    if (why.code == error_code::no_feasible_allocation
        && !held_.refused.empty())
      why.hint = refusals() + "; " + why.hint;
    if (why.code == error_code::no_feasible_allocation && could_preempt())
      why.hint += "; `--preempt` shows what of lower priority would have to go";
    done_.fail(std::move(why));
  }

  /// Whether something runs that could be preempted, and nobody has asked for
  /// it.
  bool could_preempt() const {
    int64_t least = std::numeric_limits<int64_t>::max();
    for (const auto& x : task_.steps)
      least = std::min(least, x.step.priority);
    return task_.request.preempt == preemption::none
           && std::any_of(
               task_.cell.evictable.begin(), task_.cell.evictable.end(),
               [&](const auto& x) { return x.who.priority < least; });
  }

  void adopt(task_plan& plan) {
    held_.task = {task_.request, task_.steps, std::move(plan)};
    held_.task.plan.warnings.insert(held_.task.plan.warnings.begin(),
                                    task_.warnings.begin(),
                                    task_.warnings.end());
    held_.specs = make_specs(held_.task);
    if (held_.task.plan.preempted.empty())
      return reserve();
    // There is no room yet: what is in the way goes once the place is held.
    for (auto& spec : held_.specs)
      spec.cell = task_.cell.cell;
    if (task_.request.preempt == preemption::yes)
      done_.deliver(std::move(held_));
    else
      done_.fail(must_go(held_.task.plan.preempted));
  }

  static failure must_go(const std::vector<preempted_instance>& all) {
    std::string names;
    for (const auto& x : all)
      names += (names.empty() ? "'" : ", '") + x.task + "/" + x.step + "' on '"
               + x.node + "' (priority " + std::to_string(x.priority) + ")";
    failure result{error_code::no_feasible_allocation,
                   "it fits only by preempting " + names, "/pipeline",
                   "`--preempt --yes` ends them, and starts them elsewhere "
                   "where there is room"};
    result.details = json{{"preempted", all}}.dump();
    return result;
  }

  /// Who speaks for a node of the plan.
  const node_agent_actor& agent_of(const std::string& node) const {
    const auto& nodes = task_.cell.nodes;
    const auto found =
        std::find_if(nodes.begin(), nodes.end(),
                     [&](const auto& x) { return x.name == node; });
    return task_.cell.agents[static_cast<size_t>(found - nodes.begin())];
  }

  /// One request per node, all at once.
  void reserve() {
    requests_.clear();
    for (size_t i = 0; i < held_.specs.size(); ++i) {
      held_.specs[i].cell = task_.cell.cell;
      const auto& node = held_.task.plan.allocations[i].node;
      auto& request = requests_[node];
      request.agent = agent_of(node);
      request.message.task = task_.request.task;
      request.message.cpu_floor = held_.task.plan.cpu_floor;
      request.message.specs.push_back(held_.specs[i]);
    }
    new_refusals_ = 0;
    open_ = requests_.size();
    for (const auto& [node, request] : requests_)
      reserve_on(node, request.agent, request.message);
  }

  void reserve_on(const std::string& node, const node_agent_actor& agent,
                  const instance_reservation& request) {
    auto self = shared_from_this();
    context_.call<instances_reserved>(
        agent, limits::task::reservation, request,
        [self](const instances_reserved& reply) {
          for (const auto& x : reply.refused)
            self->add_refusal(x.instance, x.reason);
          self->finish_one();
        },
        [self, node, request](const caf::error& error) {
          const auto why = to_failure(error);
          for (const auto& spec : request.specs)
            self->add_refusal(spec.instance,
                              "node '" + node + "': " + why.message);
          self->finish_one();
        },
        node);
  }

  void add_refusal(const std::string& instance, const std::string& reason) {
    for (size_t i = 0; i < held_.specs.size(); ++i) {
      if (held_.specs[i].instance != instance)
        continue;
      const auto& x = held_.task.plan.allocations[i];
      held_.refused.push_back({x.step, x.node, x.deployment, x.gpu,
                               "refused by the node: " + reason,
                               held_.task.plan.cpu_floor});
      context_.home().publish_event(events::allocation_refused,
                                    task_.request.task,
                                    {{"step", x.step},
                                     {"node", x.node},
                                     {"deployment", x.deployment},
                                     {"reason", reason}});
      ++new_refusals_;
    }
  }

  void finish_one() {
    if (--open_ > 0)
      return;
    if (new_refusals_ == 0)
      return done_.deliver(std::move(held_));
    start_again({error_code::no_feasible_allocation, refusals(), "/pipeline",
                 "the nodes' resources change; send the request again"});
  }

  /// Gives up what is kept, looks at the cell again and searches once more;
  /// ends with `why` if that was done often enough.
  void start_again(failure why) {
    auto self = shared_from_this();
    auto next = [self, why] {
      if (++self->rounds_ > limits::task::placement_rounds)
        return self->done_.fail(why);
      self->ask<cell_resources>(self->context_.services->coordinator,
                                limits::local::answer, collect_resources{},
                                [](placing& x, cell_resources& cell) {
                                  x.task_.cell = std::move(cell);
                                  x.search();
                                });
    };
    give_up_room(next);
  }

  void give_up_room(const std::function<void()>& next) {
    auto requests = std::exchange(requests_, {});
    auto open = std::make_shared<size_t>(requests.size());
    if (*open == 0)
      return next();
    auto finish = [open, next] {
      if (--*open == 0)
        next();
    };
    for (const auto& [node, request] : requests)
      context_.self
          ->request(request.agent, limits::task::reservation,
                    instance_removal{task_.request.task, ""})
          .then([finish](const instances_removed&) { finish(); },
                [finish](const caf::error&) { finish(); });
  }

  std::string refusals() const {
    std::string text = "nodes refused";
    const char* before = " ";
    for (const auto& x : held_.refused) {
      text += before + ("step '" + x.step) + "' on '" + x.node + "' ("
              + x.reason + ")";
      before = ", ";
    }
    return text;
  }

  struct request {
    node_agent_actor agent;
    instance_reservation message;
  };

  request_context context_;
  resolved_task task_;
  outcome<reserved_task> done_;
  reserved_task held_;
  std::map<std::string, request> requests_; ///< By node.
  size_t open_ = 0;
  size_t new_refusals_ = 0;
  int rounds_ = 0;
};

} // namespace

void place_with_room(const request_context& context, resolved_task task,
                     outcome<reserved_task> done) {
  std::make_shared<placing>(context, std::move(task), std::move(done))
      ->search();
}

} // namespace roscell
