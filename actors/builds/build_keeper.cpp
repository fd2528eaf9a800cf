#include "actors/builds/build_keeper.hpp"

#include "actors/builds/limits.hpp"
#include "actors/builds/stored_skill.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/edge_failure.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/expected.hpp>

#include <algorithm>
#include <set>
#include <utility>
#include <variant>

namespace roscell {

namespace {

using build_keeper_self =
    build_keeper_actor::stateful_pointer<build_keeper_state>;

build_held held(const stored_build& build) {
  return {build.name, build.pieces, build.whole};
}

caf::error unknown_build(const std::string& hash) {
  return fail(error_code::conflict,
              "the build " + hash.substr(0, limits::build::shown_digits)
                  + " is not on this node");
}

/// Whether a query can be answered with what is here.
bool is_answered(const stored_build& build, const build_query& asked) {
  return build.whole || !asked.wait
         || std::count(build.pieces.begin(), build.pieces.end(), true)
                > asked.beyond;
}

/// Answers those who wait for more of a build. Who asked has given up by the
/// time that a question is old, and makes room for others.
void answer_waiting(build_keeper_self self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  std::vector<waiting_query> still;
  for (auto& x : st.waiting) {
    const auto* build = st.store->find(x.query.hash);
    if (build != nullptr && is_answered(*build, x.query))
      x.promise.deliver(held(*build));
    else if (now - x.since > limits::build::more_call)
      x.promise.deliver(unknown_build(x.query.hash));
    else
      still.push_back(std::move(x));
  }
  st.waiting = std::move(still);
}

std::set<std::string> used_in(const instance_description& known) {
  std::set<std::string> result;
  for (const auto& x : known.instances)
    result.insert(x.spec.skill);
  return result;
}

/// Calls `next` with the hashes of what runs here; who waits hears of it if
/// that cannot be known.
template <class Reply, class Next>
caf::result<Reply> with_used(build_keeper_self self, Next next) {
  const auto& supervisor = self->state.config.supervisor;
  if (!supervisor)
    return next(std::set<std::string>{});
  auto promise = self->make_response_promise<Reply>();
  self->request(supervisor, limits::local::part, instance_query{})
      .then(
          [next, promise](const instance_description& known) mutable {
            auto outcome = next(used_in(known));
            if (outcome)
              promise.deliver(std::move(*outcome));
            else
              promise.deliver(std::move(outcome.error()));
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

caf::expected<build_held> as_held(build_keeper_self self,
                                  const edge_result<stored_build>& outcome) {
  answer_waiting(self);
  if (const auto* why = std::get_if<edge_error>(&outcome))
    return to_caf(*why);
  return held(std::get<stored_build>(outcome));
}

caf::result<build_held> offer(build_keeper_self self, const offer_build& x) {
  return with_used<build_held>(
      self,
      [self,
       x](const std::set<std::string>& used) -> caf::expected<build_held> {
        return as_held(self,
                       self->state.store->offer(x.name, x.manifest, x.cell,
                                                used, unix_now_ms()));
      });
}

caf::result<build_held> take(build_keeper_self self, const take_build& x) {
  return with_used<build_held>(
      self,
      [self,
       x](const std::set<std::string>& used) -> caf::expected<build_held> {
        return as_held(self,
                       self->state.store->take(x.folder, x.name, x.manifest,
                                               x.cell, used, unix_now_ms()));
      });
}

void publish_kept(const build_keeper_state& st, const stored_build& build) {
  st.config.context.publish_event(
      events::build_stored, build.name.hash,
      {{"bytes", build.name.bytes}, {"cell", build.cell}});
}

caf::result<build_held> store_bytes(build_keeper_self self,
                                    const store_piece& x) {
  auto& st = self->state;
  const auto* before = st.store->find(x.hash);
  const bool was_whole = before != nullptr && before->whole;
  const auto outcome =
      st.store->write(x.hash, static_cast<size_t>(x.piece), x.bytes);
  const auto* now = std::get_if<stored_build>(&outcome);
  if (now != nullptr && now->whole && !was_whole)
    publish_kept(st, *now);
  return as_held(self, outcome);
}

caf::result<build_held> look_up(build_keeper_self self, const build_query& x) {
  auto& st = self->state;
  const auto* build = st.store->find(x.hash);
  if (build != nullptr && is_answered(*build, x))
    return held(*build);
  if (!x.wait)
    return unknown_build(x.hash);
  answer_waiting(self);
  if (st.waiting.size() == limits::build::waiting)
    return fail(error_code::conflict, "too many wait for more of a build");
  auto promise = self->make_response_promise<build_held>();
  st.waiting.push_back({x, self->clock().now(), promise});
  return promise;
}

caf::result<piece_read> read(build_keeper_self self, const piece_query& x) {
  auto& store = *self->state.store;
  auto text = x.piece < 0 ? store.manifest_text(x.hash)
                          : store.read(x.hash, static_cast<size_t>(x.piece));
  if (const auto* why = std::get_if<edge_error>(&text))
    return to_caf(*why);
  auto& bytes = std::get<std::string>(text);
  self->state.config.context.count(metric::builds_sent_bytes, {},
                                   static_cast<double>(bytes.size()));
  return piece_read{std::move(bytes)};
}

caf::result<build_held> pin(build_keeper_self self, const pin_build& x) {
  auto& store = *self->state.store;
  if (store.find(x.hash) == nullptr)
    return unknown_build(x.hash);
  if (const auto why = store.pin(x.hash, x.pinned, x.cell))
    return to_caf(*why);
  return held(*store.find(x.hash));
}

caf::result<build_held> use(build_keeper_self self, const use_build& x) {
  const auto outcome = self->state.store->use(x.hash, unix_now_ms());
  if (const auto* why = std::get_if<edge_error>(&outcome))
    return to_caf(*why);
  return held(std::get<stored_build>(outcome));
}

caf::result<build_described> describe(build_keeper_self self,
                                      const describe_build& x) {
  const auto& store = *self->state.store;
  const auto* build = store.find(x.hash);
  if (build == nullptr || !build->whole)
    return unknown_build(x.hash);
  auto skill =
      read_skill(store.place_of(*build), self->state.config.architecture);
  if (const auto* why = std::get_if<edge_error>(&skill))
    return to_caf(*why);
  return build_described{build->name,
                         std::get<installed_skill>(std::move(skill))};
}

caf::result<build_dropped> drop(build_keeper_self self, const drop_build& x) {
  return with_used<build_dropped>(
      self,
      [self,
       x](const std::set<std::string>& used) -> caf::expected<build_dropped> {
        if (used.count(x.hash) != 0)
          return fail(error_code::conflict,
                      "the build "
                          + x.hash.substr(0, limits::build::shown_digits)
                          + " is in use");
        const auto why = self->state.store->drop(x.hash);
        answer_waiting(self);
        if (why)
          return to_caf(*why);
        return build_dropped{};
      });
}

/// Of what this node had of another cell it keeps what it runs. Nobody waits
/// for it: a promise would answer who has only sent word.
void belong(build_keeper_self self, const std::string& cell) {
  auto& st = self->state;
  if (!st.config.supervisor)
    return st.store->leave_cells_but(cell, {});
  self->request(st.config.supervisor, limits::local::part, instance_query{})
      .then(
          [self, cell](const instance_description& known) {
            self->state.store->leave_cells_but(cell, used_in(known));
          },
          [](const caf::error&) {});
}

} // namespace

build_keeper_actor::behavior_type
build_keeper(build_keeper_self self, const build_keeper_config& config) {
  self->state.config = config;
  self->state.store = std::make_unique<build_store>(
      config.folder, config.most_bytes,
      [own = config.architecture](const std::filesystem::path& folder) {
        return is_skill_of(folder, own);
      });
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"builds", st.store->builds().size()},
                         {"bytes", st.store->bytes()},
                         {"waiting", st.waiting.size()}});
      },
      [self](const offer_build& x) { return offer(self, x); },
      [self](const store_piece& x) { return store_bytes(self, x); },
      [self](const build_query& x) { return look_up(self, x); },
      [self](const piece_query& x) { return read(self, x); },
      [self](const pin_build& x) { return pin(self, x); },
      [self](const use_build& x) { return use(self, x); },
      [self](const describe_build& x) { return describe(self, x); },
      [self](const take_build& x) { return take(self, x); },
      [self](const drop_build& x) { return drop(self, x); },
      [self](const belong_to_cell& x) { belong(self, x.cell); },
  };
}

} // namespace roscell
