#include "actors/requests/handlers/insight.hpp"

#include "actors/core/answer_limits.hpp"

#include <atomic>
#include <map>
#include <memory>
#include <utility>

namespace roscell {

void report_placement(const request_context& context,
                      task_placement_query query,
                      outcome<task_placement> done) {
  if (auto known = context.history().placement(query.task))
    return done.deliver(*std::move(known));
  done.fail(
      failure{error_code::unknown_task,
              "no decision about a task '" + query.task + "' is kept", "/task",
              "the latest " + std::to_string(request_history::max_placements)
                  + " since the coordinator's start are; `roscell tasks "
                  + query.task + " --history` goes back further"});
}

void list_traces(const request_context& context, request_trace_query query,
                 outcome<request_traces> done) {
  std::map<uint64_t, std::string> names;
  for (auto& row : context.home().directory->rows())
    names[row.id] = std::move(row.name);
  done.deliver({context.history().traces(query.subject, [&](uint64_t id) {
    const auto i = names.find(id);
    return i == names.end() ? "an actor that has ended" : i->second;
  })});
}

void read_resources(const request_context& context, fresh_cell_query,
                    outcome<cell_query> done) {
  // What has been read is in the coordinator's registry then.
  ask<cell_resources>(context, context.services->coordinator,
                      limits::local::answer, collect_resources{}, done,
                      [done](const cell_resources&) { done.deliver({}); });
}

void report_cell(const request_context& context, cell_query query,
                 outcome<cell_description> done) {
  ask<cell_description>(
      context, context.services->coordinator, limits::local::answer, query,
      done, [done](cell_description cell) { done.deliver(std::move(cell)); });
}

namespace {

/// What has been answered. Lives as long as the requests that hold it.
class inspecting : public std::enable_shared_from_this<inspecting> {
public:
  inspecting(const request_context& context, outcome<actor_inspection> done)
      : context_(context), done_(std::move(done)) {}

  void begin(const std::vector<actor_directory::entry>& all) {
    for (const auto& x : all)
      result_.actors.push_back({x.row, ""});
    open_ = all.size();
    for (size_t i = 0; i < all.size(); ++i)
      ask(i, all[i].actor);
  }

private:
  /// An actor that is busy or blocked has nothing to show, but its counters.
  void ask(size_t i, const caf::actor& whom) {
    auto self = shared_from_this();
    context_.call<actor_state>(
        whom, limits::local::answer, state_query{},
        [self, i](const actor_state& x) {
          self->result_.actors[i].state = x.json_text;
          self->finish_one();
        },
        [self](const caf::error&) { self->finish_one(); });
  }

  void finish_one() {
    if (--open_ == 0)
      done_.deliver(std::move(result_));
  }

  request_context context_;
  outcome<actor_inspection> done_;
  actor_inspection result_;
  size_t open_ = 0;
};

} // namespace

void inspect_actors(const request_context& context, actor_query query,
                    outcome<actor_inspection> done) {
  const auto found = context.home().directory->find(query.actor, max_inspected);
  if (found.empty())
    return done.fail(failure{error_code::unknown_task,
                             "this node has no actor '" + query.actor + "'",
                             "/actor", "`roscell status --actors` lists them"});
  std::make_shared<inspecting>(context, std::move(done))->begin(found);
}

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

void list_local_skills(const request_context& context, skill_query query,
                       outcome<skill_list> done) {
  ask<node_description>(
      context, context.services->node, limits::local::answer, node_query{},
      done, [done, query](const node_description& node) {
        skill_list result;
        for (const auto& skill : node.skills)
          if (query.operation.empty()
              || skill.descriptor.operation == query.operation)
            result.skills.push_back(
                {skill, {node.identity.name}, {skill.added_unix_ms}});
        for (const auto& problem : node.refused_skills)
          result.refused.push_back({node.identity.name, problem});
        done.deliver(std::move(result));
      });
}

} // namespace roscell
