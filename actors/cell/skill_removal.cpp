#include "actors/builds/limits.hpp"
#include "actors/cell/skill_additions.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace roscell {

namespace {

std::string shown_build(const std::string& hash) {
  return hash.substr(0, limits::build::shown_digits);
}

bool starts_with(const std::string& text, const std::string& begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

/// An instance of the build that has not ended, if there is one.
std::string user_of(const cell_coordinator_state& st, const std::string& hash) {
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& x : st.deployments.of_task(task))
      if (!x.end && x.spec.skill == hash)
        return x.spec.instance;
  return {};
}

/// Where copies of it are, whether the node is there now or not.
build_remains remains_of(const cell_coordinator_state& st,
                         const cell_build& build) {
  build_remains result{build.build.hash, build.keepers, unix_now_ms()};
  for (const auto& node : nodes_with(st, build.build.hash))
    if (std::find(result.nodes.begin(), result.nodes.end(), node)
        == result.nodes.end())
      result.nodes.push_back(node);
  return result;
}

/// The node has let it go; what is written of that need not be.
void on_released(coordinator_pointer self, const std::string& hash,
                 const std::string& node) {
  auto& builds = self->state.builds;
  if (builds.release(hash, node))
    keep_records(
        self, {{remains_table, hash, ""}}, [] {}, [](const failure&) {});
}

void forget_builds(coordinator_pointer self,
                   const std::vector<cell_build>& gone,
                   const std::vector<build_remains>& remains) {
  std::set<std::string> nodes;
  for (const auto& x : gone)
    self->state.context.publish_event(
        events::cell_skill_removed, x.skill.descriptor.operation,
        {{"hash", x.skill.hash}, {"version", x.skill.version}});
  for (const auto& x : remains) {
    self->state.builds.remove(x);
    nodes.insert(x.nodes.begin(), x.nodes.end());
  }
  for (const auto& node : nodes)
    release_remains(self, node);
}

caf::error no_such_build(const std::string& operation,
                         const std::string& build) {
  return fail(error_code::unknown_operation,
              "the cell has no build " + (build.empty() ? "" : build + " ")
                  + "of '" + operation + "'",
              "/operation", "`roscell skill list` shows those that it has");
}

/// The newest of those whose hash begins so.
std::optional<cell_build> newest_of(const cell_coordinator_state& st,
                                    const skill_pull& request) {
  const auto all = st.builds.of(request.operation);
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& x) {
    return starts_with(x.build.hash, request.build);
  });
  return found == all.end() ? std::nullopt : std::optional{*found};
}

} // namespace

caf::result<skill_removed> remove_skill(coordinator_pointer self,
                                        const skill_removal& request) {
  auto& st = self->state;
  skill_removed result;
  std::vector<store_record> records;
  std::vector<build_remains> remains;
  for (const auto& x : st.builds.of(request.operation)) {
    if (!starts_with(x.build.hash, request.build))
      continue;
    if (const auto user = user_of(st, x.build.hash); !user.empty())
      return fail(error_code::conflict,
                  "build " + shown_build(x.build.hash) + " of '"
                      + request.operation + "' runs as '" + user + "'",
                  "/operation", "stop its task first");
    result.removed.push_back(x);
    remains.push_back(remains_of(st, x));
    records.push_back({builds_table, x.build.hash, ""});
    records.push_back(
        {remains_table, x.build.hash, json(remains.back()).dump()});
  }
  if (result.removed.empty())
    return no_such_build(request.operation, request.build);
  auto promise = self->make_response_promise<skill_removed>();
  keep_records(
      self, std::move(records),
      [self, result, remains, promise]() mutable {
        forget_builds(self, result.removed, remains);
        promise.deliver(result);
      },
      [promise](const failure& why) mutable {
        promise.deliver(to_error(why));
      });
  return promise;
}

/// May be interrupted by the end of the node: then it is done when it comes
/// back.
void release_remains(coordinator_pointer self, const std::string& node) {
  const auto* entry = self->state.registry.find_name(node);
  if (entry == nullptr || !entry->agent || !entry->fetches_builds)
    return;
  const auto& st = self->state;
  for (const auto& hash : st.builds.remains_on(node)) {
    const auto done = [self, hash, node] { on_released(self, hash, node); };
    // At its start the coordinator's own agent knows of no keeper yet.
    if (node == st.setup.self.name)
      self->request(st.setup.keeper, limits::build::disk, drop_build{hash})
          .then([done](const build_dropped&) { done(); },
                [](const caf::error&) {});
    else
      self->request(entry->agent, limits::build::disk, build_release{hash})
          .then([done](const build_released&) { done(); },
                [](const caf::error&) {});
  }
}

/// May be interrupted by the end of the node, or of its coordinator: what has
/// come stays there.
caf::result<skill_pulled> pull_skill(coordinator_pointer self,
                                     const skill_pull& request) {
  auto& st = self->state;
  const auto build = newest_of(st, request);
  if (!build)
    return no_such_build(request.operation, request.build);
  const auto* entry = st.registry.find_name(request.node);
  if (entry == nullptr || !entry->agent)
    return fail(error_code::unknown_node,
                "no node '" + request.node + "' is there in this cell", "/node",
                "`roscell nodes` lists them");
  if (!entry->fetches_builds)
    return fail(error_code::conflict,
                "node '" + request.node + "' gets no builds from others",
                "/node", "is it of this version of ROSCell?");
  auto promise = self->make_response_promise<skill_pulled>();
  self->request(entry->agent, limits::build::keeping_answer,
                build_keeping{st.setup.cell, offer_of(st, *build, request.node),
                              false})
      .then(
          [promise, x = *build](const build_kept&) mutable {
            promise.deliver(skill_pulled{x});
          },
          [promise](const caf::error& why) mutable { promise.deliver(why); });
  return promise;
}

} // namespace roscell
