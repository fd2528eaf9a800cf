#include "actors/requests/handlers/actor_inspecting.hpp"

#include "actors/core/answer_limits.hpp"

#include <memory>
#include <utility>

namespace roscell {

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

} // namespace roscell
