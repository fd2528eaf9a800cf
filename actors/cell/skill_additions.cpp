#include "actors/cell/skill_additions.hpp"

#include "actors/builds/limits.hpp"
#include "actors/cell/limits.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

/// A build on its way to be one of the cell's. Each step may be interrupted by
/// the end of the node that it asks: then the request fails.
struct addition {
  skill_addition request;
  cell_build build;
  build_remains copies; ///< Those that the nodes let go if it fails.
  std::vector<std::string> candidates; ///< For the second copy, the best first.
  size_t tried = 0;
  std::string last_problem;
  caf::typed_response_promise<skill_added> promise;
};

using addition_ptr = std::shared_ptr<addition>;

/// The copies that it has made go.
void refuse_addition(coordinator_pointer self, const addition_ptr& x,
                     const failure& why) {
  self->state.builds.restore(x->copies);
  for (const auto& node : x->copies.nodes)
    release_remains(self, node);
  self->state.additions.erase(x->build.build.hash);
  x->promise.deliver(to_error(why));
}

/// That a node holds a copy is written down before it does: a coordinator that
/// ends before the addition has ended has it let go when both are back.
template <class Next>
void expect_copy(coordinator_pointer self, const addition_ptr& x,
                 const std::string& node, Next next) {
  x->copies.nodes.push_back(node);
  keep_records(
      self, {{remains_table, x->build.build.hash, json(x->copies).dump()}},
      std::move(next),
      [self, x](const failure& why) { refuse_addition(self, x, why); });
}

/// Nodes that can hold the second copy: the one that has it already, then
/// those with the most room.
std::vector<std::string> second_keepers(const cell_coordinator_state& st,
                                        const std::string& holder) {
  std::vector<std::pair<double, std::string>> nodes;
  for (const auto& row : st.registry.rows()) {
    const auto* entry = st.registry.find_uuid(row.identity.uuid);
    if (row.state != row_state::active || !entry->fetches_builds
        || row.identity.uuid == st.setup.self.uuid)
      continue;
    const auto& disk = row.resources.disk_mib;
    const bool first = row.identity.name == holder;
    nodes.emplace_back(first ? disk.capacity + 1 : disk.capacity - disk.used,
                       row.identity.name);
  }
  std::sort(nodes.rbegin(), nodes.rend());
  std::vector<std::string> result;
  for (auto& [room, name] : nodes)
    if (result.size() < limits::build::keepers_tried)
      result.push_back(std::move(name));
  return result;
}

void on_addition_persisted(coordinator_pointer self, const addition_ptr& x) {
  const auto& skill = x->build.skill;
  self->state.context.publish_event(events::cell_skill_added,
                                    skill.descriptor.operation,
                                    {{"hash", skill.hash},
                                     {"version", skill.version},
                                     {"bytes", x->build.build.bytes},
                                     {"keepers", x->build.keepers},
                                     {"signed_by", x->build.signed_by}});
  self->state.additions.erase(x->build.build.hash);
  x->promise.deliver(skill_added{x->build});
}

/// It counts from here on, so that no other one of its version comes before it
/// is written down.
void record_addition(coordinator_pointer self, const addition_ptr& x) {
  auto& builds = self->state.builds;
  if (const auto why = builds.refusal(x->build))
    return refuse_addition(self, x, *why);
  builds.add(x->build);
  const json record = x->build;
  keep_records(
      self,
      {{builds_table, x->build.build.hash, record.dump()},
       {remains_table, x->build.build.hash, ""}},
      [self, x] { on_addition_persisted(self, x); },
      [self, x](const failure& why) {
        self->state.builds.remove({x->build.build.hash, {}, 0});
        refuse_addition(self, x, why);
      });
}

/// From here on the copy on this node stays, too.
void pin_own_copy(coordinator_pointer self, const addition_ptr& x) {
  const auto& st = self->state;
  self->request(st.setup.keeper, limits::build::disk,
                pin_build{x->build.build.hash, true, st.setup.cell})
      .then([self, x](const build_held&) { record_addition(self, x); },
            [self, x](const caf::error& why) {
              refuse_addition(self, x, to_failure(why));
            });
}

void conclude_addition(coordinator_pointer self, const addition_ptr& x) {
  expect_copy(self, x, self->state.setup.self.name,
              [self, x] { pin_own_copy(self, x); });
}

void keep_second_copy(coordinator_pointer self, const addition_ptr& x);

/// The node may have ended meanwhile: then the next one is asked.
void ask_for_second_copy(coordinator_pointer self, const addition_ptr& x,
                         const std::string& node) {
  auto& st = self->state;
  const auto* entry = st.registry.find_name(node);
  if (entry == nullptr || !entry->agent)
    return keep_second_copy(self, x);
  const auto offer = offer_from(st, x->build.build, node,
                                {st.setup.self.name, x->request.node});
  self->request(entry->agent, limits::build::keeping_answer,
                build_keeping{st.setup.cell, offer})
      .then(
          [self, x, node](const build_kept&) {
            x->build.keepers.push_back(node);
            conclude_addition(self, x);
          },
          [self, x, node](const caf::error& why) {
            x->last_problem = node + ": " + to_failure(why).message;
            keep_second_copy(self, x);
          });
}

/// Has the next candidate hold the second copy. In a cell of one node, or where
/// all others are of an earlier version, there is none.
void keep_second_copy(coordinator_pointer self, const addition_ptr& x) {
  if (x->candidates.empty())
    return conclude_addition(self, x);
  if (x->tried == x->candidates.size())
    return refuse_addition(
        self, x,
        {error_code::unreachable,
         "no second node could be given the build: " + x->last_problem, "",
         "it is on the coordination node; add it again", ""});
  const auto node = x->candidates[x->tried++];
  expect_copy(self, x, node,
              [self, x, node] { ask_for_second_copy(self, x, node); });
}

void on_described(coordinator_pointer self, const addition_ptr& x,
                  const build_described& known) {
  auto& st = self->state;
  x->build.skill = known.skill;
  x->build.skill.added_unix_ms = x->build.added_unix_ms = unix_now_ms();
  x->build.keepers = {st.setup.self.name};
  if (const auto why = st.builds.refusal(x->build))
    return refuse_addition(self, x, *why);
  keep_second_copy(self, x);
}

/// The coordination node has it: now it can be looked at.
void describe_addition(coordinator_pointer self, const addition_ptr& x) {
  self->request(self->state.setup.keeper, limits::build::disk,
                describe_build{x->request.build.hash})
      .then([self,
             x](const build_described& known) { on_described(self, x, known); },
            [self, x](const caf::error& why) {
              refuse_addition(self, x, to_failure(why));
            });
}

/// Empty: by nobody, and it need not be.
std::variant<std::string, failure> signer_of(const coordinator_setup& setup,
                                             const skill_addition& request) {
  if (!request.signature.empty() && setup.check_signature)
    return setup.check_signature(request.build.hash, request.signature);
  if (!setup.require_signed_skills)
    return std::string{};
  return failure{
      error_code::unauthorized,
      "this cell takes skills only that an operator has signed", "/signature",
      "`roscell skill sign` makes the signature, beside the skill", ""};
}

/// A build of the cell that somebody has signed since.
caf::result<skill_added> note_signer(coordinator_pointer self, cell_build known,
                                     const std::string& signed_by) {
  if (signed_by.empty() || !known.signed_by.empty())
    return skill_added{known};
  known.signed_by = signed_by;
  auto promise = self->make_response_promise<skill_added>();
  const json record = known;
  keep_records(
      self, {{builds_table, known.build.hash, record.dump()}},
      [self, known, promise]() mutable {
        // It may have been removed meanwhile.
        if (self->state.builds.find(known.build.hash))
          self->state.builds.add(known);
        promise.deliver(skill_added{known});
      },
      [promise](const failure& why) mutable {
        promise.deliver(to_error(why));
      });
  return promise;
}

} // namespace

void restore_builds(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& x : st.setup.remains)
    st.builds.restore(x);
  for (const auto& x : st.setup.builds)
    st.builds.add(x);
  // Nobody registers this node.
  release_remains(self, st.setup.self.name);
}

caf::result<skill_added> add_skill(coordinator_pointer self,
                                   const skill_addition& request) {
  auto& st = self->state;
  const auto signer = signer_of(st.setup, request);
  if (const auto* why = std::get_if<failure>(&signer))
    return to_error(*why);
  const auto& signed_by = std::get<std::string>(signer);
  if (const auto known = st.builds.find(request.build.hash))
    return note_signer(self, *known, signed_by);
  if (!st.setup.keeper)
    return fail(error_code::conflict, "this coordinator keeps no builds");
  if (st.registry.find_name(request.node) == nullptr)
    return fail(error_code::unknown_node,
                "this cell has no node '" + request.node + "'", "/node",
                "`roscell nodes` lists them");
  // Where one of two fails, its copies go, which the other counts on.
  if (!st.additions.insert(request.build.hash).second)
    return fail(error_code::conflict, "this build is being added already",
                "/build", "wait for that, and look with `roscell skill list`");
  auto x = std::make_shared<addition>();
  x->request = request;
  x->build.build = request.build;
  x->build.signed_by = signed_by;
  x->copies = {request.build.hash, {}, unix_now_ms()};
  x->candidates = second_keepers(st, request.node);
  x->promise = self->make_response_promise<skill_added>();
  const auto offer =
      offer_from(st, request.build, st.setup.self.name, {request.node});
  self->request(st.setup.agent, limits::build::keeping_answer,
                build_keeping{st.setup.cell, offer, false})
      .then([self, x](const build_kept&) { describe_addition(self, x); },
            [self, x](const caf::error& why) {
              refuse_addition(self, x, to_failure(why));
            });
  return x->promise;
}

} // namespace roscell
