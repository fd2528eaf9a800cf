#include "test/actors/fakes/trial_node.hpp"

#include "actors/edge/session/limits.hpp"
#include "actors/placement/reservation.hpp"

#include <algorithm>
#include <iostream>
#include <utility>

namespace roscell::test {

using std::chrono::milliseconds;

namespace {

constexpr milliseconds heartbeat{4000};

caf::error out_of_reach(const std::string& node) {
  return fail(error_code::unreachable, "node '" + node + "' is out of reach");
}

} // namespace

trial_node::trial_node(trial_site& site, const std::string& name)
    : site_(site) {
  identity_ = {name, "uuid-of-" + name, 0, "10.0.0.9:8420"};
  actor_ = site.cell.time.system.spawn(
      [this](caf::event_based_actor* self) { return act(self); });
}

caf::behavior trial_node::act(caf::event_based_actor* self) {
  return {
      [=](const resource_query&) {
        auto promise = self->make_response_promise();
        if (is_reached_by(promise))
          promise.deliver(report());
      },
      [=](const instance_reservation& request) {
        auto promise = self->make_response_promise();
        if (!is_reached_by(promise))
          return;
        instances_reserved reply;
        if (site_.chance(4))
          reply.refused.push_back({request.specs.front().instance, "too busy"});
        promise.deliver(reply);
      },
      [=](const instance_deployment& request) {
        on_deployment(self->make_response_promise(), request.spec);
      },
      [=](const instance_removal& what) {
        on_removal(self->make_response_promise(), what);
      },
      [=](const figures_query&) { return figures_report{}; },
      [=](const registration_switch& order) {
        on_switch(self->make_response_promise(), order);
      },
      [=](const close_session&) {
        linked_ = false;
        set_fences(site_.now());
        lost_at_ = site_.now();
      },
      [=](caf::tick_atom) {
        for (const auto& work : std::exchange(todo_, {}))
          work();
      },
  };
}

void trial_node::inside(std::function<void()> work) {
  todo_.push_back(std::move(work));
  caf::anon_send(actor_, caf::tick_atom_v);
}

/// Whether a message gets through.
bool trial_node::takes_order() {
  return session_ && linked_;
}

/// What does not get through stays unanswered until the session is lost;
/// without one it fails at once.
bool trial_node::is_reached_by(caf::response_promise promise) {
  if (!session_)
    promise.deliver(out_of_reach(identity_.name));
  else if (!linked_)
    unanswered_.push_back(promise);
  return takes_order();
}

resource_report trial_node::report() const {
  node_resources has;
  has.name = identity_.name;
  has.architecture = "amd64";
  has.cpu = {4, 0};
  has.memory_mib = {1000, 0};
  has.disk_mib = {1000, 0};
  has.labels = {{"is", identity_.name}};
  for (const auto& [id, x] : programs_)
    reserve(has, x.spec.resources, x.spec.gpu);
  return {has, {}};
}

instance_row trial_node::row(const trial_program& x) const {
  auto result =
      row_of(x.spec, identity_.name,
             x.is_ready ? instance_state::running : instance_state::starting);
  if (x.ends_at != trial_program::never)
    result.unsafe_since_unix_ms = 1;
  return result;
}

void trial_node::report_row(const instance_row& row) {
  if (takes_order())
    caf::send_as(actor_, site_.cell.coordinator, instance_changed{row});
  else if (!is_live(row.state))
    untold_.push_back(row);
}

// -- programs ----------------------------------------------------------------

void trial_node::begin(const instance_spec& spec,
                       std::optional<caf::response_promise> deployed) {
  site_.watch_start(*this, spec);
  trial_program x;
  x.spec = spec;
  x.comes_up = !site_.chance(7);
  constexpr int seconds[]{0, 0, 1, 6, 40};
  x.ready_at = site_.now() + std::chrono::seconds{seconds[site_.pick(5)]};
  if (site_.chance(15))
    x.ready_at += std::chrono::milliseconds{site_.pick(90'000)};
  x.deployed = std::move(deployed);
  report_row(row(x));
  programs_[spec.instance] = std::move(x);
}

void trial_node::end(const std::string& instance, instance_state state,
                     const std::string& reason) {
  const auto known = programs_.find(instance);
  if (known == programs_.end())
    return;
  auto x = std::move(known->second);
  programs_.erase(known);
  site_.note(identity_.name + ": " + instance + " ends: " + reason);
  auto reported = row(x);
  reported.state = state;
  reported.exit_code = state == instance_state::stopped ? 0 : 3;
  reported.reason = reason;
  report_row(reported);
  if (x.deployed)
    x.deployed->deliver(fail(error_code::engine_failed, reason));
  settle_removals();
}

void trial_node::finish(const std::string& instance) {
  inside(
      [=] { end(instance, instance_state::stopped, "it has done its work"); });
}

void trial_node::on_deployment(caf::response_promise promise,
                               const instance_spec& spec) {
  if (!session_)
    return promise.deliver(out_of_reach(identity_.name));
  // What was sent just before the silence may have come, and nobody hears of
  // it.
  if (!linked_ && !site_.chance(30)) {
    unanswered_.push_back(promise);
    return;
  }
  if (programs_.count(spec.instance) > 0)
    return promise.deliver(fail(error_code::conflict, "it is there"));
  begin(spec, promise);
  if (!linked_)
    set_fences(proven_);
}

/// The moment until which a program may run on, if the last word that the
/// coordinator is known to have heard was sent then.
void trial_node::set_fences(time_point proven) {
  proven_ = proven;
  for (auto& [id, x] : programs_) {
    const auto& loss = x.spec.life.on_node_loss;
    if (loss.policy == loss_action::move)
      x.fence = proven + milliseconds{static_cast<int64_t>(loss.after_s * 1000)}
                - limits::lease::span;
  }
}

void trial_node::on_removal(caf::response_promise promise,
                            const instance_removal& what) {
  if (!is_reached_by(promise))
    return;
  removal x{promise, {}, {}};
  constexpr int safe_after_s[]{1, 3, 20, 20, 100, 2000};
  for (auto& [id, program] : programs_) {
    if (program.spec.task != what.task
        || (!what.instance.empty() && what.instance != id))
      continue;
    if (program.spec.life.safe_state && program.is_ready && !what.force) {
      if (program.ends_at == trial_program::never)
        program.ends_at =
            site_.now() + std::chrono::seconds{safe_after_s[site_.pick(6)]};
      x.reply.waiting.push_back(
          {id, what.task, program.spec.step, identity_.name, 1000, 0});
      continue;
    }
    program.ends_at =
        std::min(program.ends_at, site_.now() + milliseconds{site_.pick(6000)});
    x.left.push_back(id);
    x.reply.instances.push_back(id);
  }
  // It may never be answered, though it is done.
  if (site_.chance(3))
    unanswered_.push_back(promise);
  else
    removals_.push_back(std::move(x));
  settle_removals();
}

void trial_node::settle_removals() {
  auto open = std::exchange(removals_, {});
  for (auto& x : open) {
    x.left.erase(std::remove_if(
                     x.left.begin(), x.left.end(),
                     [&](const auto& id) { return programs_.count(id) == 0; }),
                 x.left.end());
    if (x.left.empty())
      x.promise.deliver(x.reply);
    else
      removals_.push_back(std::move(x));
  }
}

// -- the session -------------------------------------------------------------

void trial_node::on_switch(caf::response_promise promise,
                           const registration_switch& order) {
  if (!is_reached_by(promise))
    return;
  departing_ = true;
  promise.deliver(switch_accepted{order.epoch + 1});
}

void trial_node::join() {
  ++identity_.epoch;
  session_ = linked_ = true;
  reported_lost_ = false;
  departing_ = false;
  lost_at_ = trial_program::never;
  node_registration registration;
  registration.identity = identity_;
  registration.incarnation = 3;
  registration.resources = report().resources;
  registration.skills = {echo_skill(), grasp_skill()};
  for (auto& [id, x] : programs_) {
    x.fence = trial_program::never;
    registration.instances.push_back(row(x));
  }
  for (const auto& [id, spec] : fenced_)
    registration.instances.push_back(
        row_of(spec, identity_.name, instance_state::backing_off));
  for (auto& x : std::exchange(untold_, {}))
    registration.instances.push_back(std::move(x));
  site_.note(identity_.name + " joins with "
             + std::to_string(registration.instances.size()));
  auto reply = site_.cell.time.ask<node_registered>(
      site_.cell.coordinator,
      register_node{registration, caf::actor_cast<member_actor>(actor_)});
  site_.cell.time.settle();
  if (!*reply || !**reply) {
    session_ = linked_ = false;
    return;
  }
  inside([this, reported = ***reply] { obey(reported); });
  site_.cell.time.settle();
}

void trial_node::obey(const node_registered& reply) {
  for (const auto& x : reply.verdicts) {
    site_.note(identity_.name + " is told to " + std::string{to_word(x.what)}
               + " " + x.instance);
    const auto fenced = fenced_.find(x.instance);
    if (fenced != fenced_.end()) {
      const auto spec = std::exchange(fenced->second, {});
      fenced_.erase(fenced);
      if (x.what == verdict::keep)
        begin(spec, std::nullopt);
      else
        report_row(row_of(spec, identity_.name, instance_state::stopped));
      continue;
    }
    const auto known = programs_.find(x.instance);
    if (x.what == verdict::start && known == programs_.end())
      begin(x.spec.front(), std::nullopt);
    // Sometimes a node does not do it.
    if (x.what != verdict::stop || known == programs_.end() || site_.chance(20))
      continue;
    auto& program = known->second;
    const bool waits = program.spec.life.safe_state && program.is_ready;
    program.ends_at =
        std::min(program.ends_at,
                 site_.now() + milliseconds{site_.pick(waits ? 60'000 : 5000)});
  }
}

void trial_node::cut(bool is_broken) {
  if (!linked_)
    return;
  linked_ = false;
  // The last word that was heard, and the last one of which the node knows
  // that it was.
  const auto heard = site_.now() - milliseconds{site_.pick(heartbeat.count())};
  proven_ = heard - milliseconds{site_.pick(heartbeat.count())};
  lost_at_ = is_broken ? site_.now() : heard + limits::lease::span;
  silent_ms_ =
      std::chrono::duration_cast<milliseconds>(lost_at_ - heard).count();
  set_fences(proven_);
  site_.note(identity_.name + (is_broken ? " breaks off" : " falls silent"));
}

/// As `end_member` does: first what it was asked for fails, then it is told.
void trial_node::lose_session() {
  lost_at_ = trial_program::never;
  if (!session_)
    return;
  session_ = linked_ = false;
  site_.note(identity_.name + " is lost");
  inside([this] {
    for (auto& promise : std::exchange(unanswered_, {}))
      promise.deliver(out_of_reach(identity_.name));
    for (auto& x : std::exchange(removals_, {}))
      x.promise.deliver(out_of_reach(identity_.name));
    for (auto& [id, x] : programs_)
      if (auto promise = std::exchange(x.deployed, std::nullopt))
        promise->deliver(out_of_reach(identity_.name));
  });
  // Between the two messages others may be handled, or none.
  const bool at_once = site_.chance(50);
  if (!at_once)
    site_.cell.time.settle();
  reported_lost_ = !at_once;
  report_loss();
  site_.cell.time.settle();
  reported_lost_ = true;
}

void trial_node::report_loss() {
  inside([this] {
    caf::send_as(actor_, site_.cell.coordinator,
                 member_lost{identity_.uuid,
                             caf::actor_cast<member_actor>(actor_), "gone",
                             silent_ms_});
  });
}

trial_node::time_point trial_node::next_due() const {
  auto result = lost_at_;
  if (departing_ && session_)
    result = std::min(result, site_.now());
  for (const auto& [id, x] : programs_)
    result = std::min({result, x.ready_at, x.ends_at, x.fence});
  return result;
}

void trial_node::work() {
  const auto now = site_.now();
  if (departing_ && session_) {
    // It is in no cell, and ends what it has.
    session_ = linked_ = departing_ = false;
    site_.note(identity_.name + " has gone");
    inside([this] {
      for (auto& promise : std::exchange(unanswered_, {}))
        promise.deliver(out_of_reach(identity_.name));
      auto all = programs_;
      for (auto& [id, x] : all)
        end(id, instance_state::stopped, "its node has left");
      untold_.clear();
    });
  }
  if (lost_at_ <= now)
    lose_session();
  std::vector<std::string> due;
  for (const auto& [id, x] : programs_)
    if (std::min({x.ready_at, x.ends_at, x.fence}) <= now)
      due.push_back(id);
  if (!due.empty())
    inside([this, due, now] {
      for (const auto& id : due) {
        const auto known = programs_.find(id);
        if (known == programs_.end())
          continue;
        auto& x = known->second;
        if (x.fence <= now) {
          site_.note(name() + ": the fence of " + id + " has passed");
          fenced_[id] = x.spec;
          programs_.erase(known);
        } else if (x.ends_at <= now) {
          end(id, instance_state::stopped, "it was told to");
        } else if (x.ready_at <= now && !x.comes_up) {
          end(id, instance_state::failed, "no camera");
        } else if (x.ready_at <= now) {
          x.ready_at = trial_program::never;
          x.is_ready = true;
          report_row(row(x));
          if (auto promise = std::exchange(x.deployed, std::nullopt))
            promise->deliver(instance_deployed{row(x)});
        }
      }
    });
  site_.cell.time.settle();
}

void trial_node::drop_promises() {
  unanswered_.clear();
  removals_.clear();
  for (auto& [id, x] : programs_)
    x.deployed = std::nullopt;
  site_.cell.time.kill(actor_);
}

// -- the site ----------------------------------------------------------------

trial_site::trial_site(paper_cell& where, uint32_t seed, bool reports)
    : cell(where), random_(seed + 1), begun_(now()), reports_(reports) {}

trial_node& trial_site::add(const std::string& name) {
  nodes.push_back(std::make_unique<trial_node>(*this, name));
  return *nodes.back();
}

void trial_site::live(milliseconds span) {
  const auto end = now() + span;
  for (;;) {
    auto next = end;
    for (const auto& x : nodes)
      next = std::min(next, std::max(now(), x->next_due()));
    // What the coordinator does then the nodes may have to answer at once.
    cell.time.settle();
    const auto& clock = cell.time.scheduler.clock();
    if (clock.has_pending_timeout())
      next = std::min(next, std::max(now(), clock.schedule().begin()->first));
    cell.time.pass(std::chrono::ceil<milliseconds>(next - now()));
    for (const auto& x : nodes)
      x->work();
    if (now() >= end || !fault.empty())
      return;
  }
}

void trial_site::watch_start(const trial_node& on, const instance_spec& spec) {
  ++starts;
  note(on.name() + ": " + spec.instance + " begins");
  size_t others = 0;
  for (const auto& node : nodes)
    for (const auto& [id, x] : node->programs()) {
      if (x.spec.task != spec.task || x.spec.step != spec.step)
        continue;
      const auto two = id + " on " + node->name() + " and " + spec.instance
                       + " on " + on.name();
      if (spec.life.safe_state)
        fault = "two that have to be stop-safe: " + two;
      else if (node->is_reported_lost())
        fault = "one runs where nobody can end it: " + two;
      else if (++others > 1)
        fault = "three at once: " + two;
    }
}

void trial_site::note(const std::string& what) {
  if (!reports_)
    return;
  const auto at = std::chrono::duration_cast<milliseconds>(now() - begun_);
  std::cerr << static_cast<double>(at.count()) / 1000 << " s: " << what << "\n";
}

} // namespace roscell::test
