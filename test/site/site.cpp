#include "test/site/site.hpp"

#include "test/site/site_start.hpp"

#include <caf/actor_cast.hpp>

#include <algorithm>
#include <utility>

namespace roscell::test {

// -- a party -----------------------------------------------------------------

caf::actor site_party::brain() const {
  return coordinates ? caf::actor_cast<caf::actor>(coordinator)
                     : caf::actor_cast<caf::actor>(membership);
}

cell_coordinator_state& site_party::cell_state() const {
  auto* actor = caf::actor_cast<caf::abstract_actor*>(coordinator);
  return dynamic_cast<coordinator_pointer>(actor)->state;
}

membership_status& site_party::status() const {
  using pointer = membership_actor::stateful_pointer<membership_status>;
  auto* actor = caf::actor_cast<caf::abstract_actor*>(membership);
  return dynamic_cast<pointer>(actor)->state;
}

std::vector<caf::actor> site_party::actors() const {
  std::vector<caf::actor> result;
  const auto add = [&](const auto& x) {
    if (x)
      result.push_back(caf::actor_cast<caf::actor>(x));
  };
  add(coordinator);
  add(membership);
  add(router);
  add(planner);
  add(agent);
  add(supervisor);
  add(edge);
  return result;
}

void site_party::forget_actors() {
  edge = nullptr;
  coordinator = nullptr;
  membership = nullptr;
  supervisor = nullptr;
  listener = nullptr;
  agent = nullptr;
  planner = nullptr;
  router = nullptr;
}

// -- the site ----------------------------------------------------------------

site::site(virtual_time& clock, uint32_t seed)
    : time(clock), random(seed), context(clock.context),
      start_(clock.scheduler.clock().now()) {
  // nop
}

site::~site() {
  for (auto& x : parties)
    kill(*x);
  for (auto& x : connections)
    cut(*x.link);
  for (const auto& x : event_collectors_)
    time.kill(x);
  time.scheduler.clock().cancel_all();
}

size_t site::count(const std::string& event) const {
  return static_cast<size_t>(
      std::count_if(events.begin(), events.end(),
                    [&](const auto& x) { return x.what == event; }));
}

void site::collect_events(site_party& x) {
  event_collectors_.push_back(time.system.spawn(
      [this, &x](caf::event_based_actor* self) -> caf::behavior {
        return {[this, &x, self](const record_event& event) {
          const auto when =
              std::chrono::duration_cast<std::chrono::milliseconds>(
                  self->clock().now() - start_);
          auto data =
              event.data.empty() ? json::object() : json::parse(event.data);
          events.push_back({when, x.index, x.life, event.what, event.subject,
                            std::move(data)});
        }};
      }));
  x.context = context;
  x.context.events = caf::actor_cast<event_log_actor>(event_collectors_.back());
}

site_party& site::add_party(const std::string& name) {
  auto& x = *parties.emplace_back(std::make_unique<site_party>());
  x.index = parties.size() - 1;
  const auto number = std::to_string(x.index);
  x.name = name + "-" + number;
  x.address = "10.0.0." + number + ":8420";
  collect_events(x);
  return x;
}

site_party& site::add_coordinator(const std::string& uuid) {
  auto& x = add_party("base");
  const auto number = std::to_string(x.index);
  x.coordinates = true;
  x.uuid = uuid;
  x.cell = "cell-" + number;
  x.discovery_server = "10.0.0." + number + ":11811";
  return x;
}

site_party& site::add_node(const std::string& configured) {
  auto& x = add_party("arm");
  x.uuid = "a-" + std::to_string(x.index);
  x.configured = configured;
  return x;
}

void site::start(site_party& x) {
  if (x.alive())
    return;
  ++x.life;
  x.context.directory = std::make_shared<actor_directory>();
  x.edge = time.system.spawn(site_edge, this, &x);
  resume_programs(*this, x);
  start_parts(*this, x);
  for (auto& other : parties)
    if (x.coordinates && other->looking_for == x.discovery_server)
      look_up(*other);
}

void site::kill(site_party& x) {
  if (!x.alive())
    return;
  thaw(x);
  auto doomed = x.actors();
  for (const auto& c : connections)
    for (size_t end = 0; end < 2; ++end)
      if (c.parties[end] == x.index)
        if (auto owner = caf::actor_cast<caf::actor>(c.link->owners[end]))
          doomed.push_back(owner);
  // All at once, so that none has time for last words.
  for (const auto& actor : doomed)
    caf::anon_send_exit(actor, caf::exit_reason::kill);
  x.forget_actors();
  x.waiting.clear();
  x.looking_for.clear();
  x.announced.reset();
  x.shown.clear();
  close_calls(x);
  // The kernel closes what had no owner yet.
  for (const auto& c : connections)
    for (size_t end = 0; end < 2; ++end)
      if (c.parties[end] == x.index && !c.link->owners[end])
        caf::anon_send(c.link->ends[end], close_session{"the peer has ended"});
  for (auto& viewer : parties)
    fade(*viewer, x.index, ghost_span + std::chrono::seconds{pick(30)});
  settle();
}

void site::close_calls(const site_party& x) {
  for (auto& request : requests)
    request.closed |= request.asked == x.index && !request.is_answered();
  for (auto& task : tasks)
    for (auto& call : task->calls)
      call.closed |= task->cell == x.index && !call.answered();
}

void site::crash(site_party& x) {
  kill(x);
  end_programs(x);
}

// -- time --------------------------------------------------------------------

bool site::pass_until(std::chrono::milliseconds span,
                      const std::function<bool()>& stop) {
  auto& clock = time.scheduler.clock();
  const auto end = clock.now() + span;
  for (;;) {
    while (run_one())
      if (stop())
        return true;
    if (!clock.has_pending_timeout() || clock.schedule().begin()->first > end)
      break;
    const auto next = clock.schedule().begin()->first;
    clock.advance_time(std::max(next - clock.now(), decltype(next - next){0}));
  }
  clock.advance_time(end - clock.now());
  return false;
}

void site::settle() {
  while (run_one())
    continue;
}

bool site::run_one() {
  keep_frozen_back();
  return time.scheduler.try_run_once();
}

void site::keep_frozen_back() {
  if (frozen_.empty())
    return;
  auto& jobs = time.scheduler.jobs;
  for (auto& [party, ids] : frozen_)
    for (auto i = jobs.begin(); i != jobs.end();) {
      const auto* actor = dynamic_cast<caf::abstract_actor*>(*i);
      if (!actor || ids.count(actor->id()) == 0) {
        ++i;
        continue;
      }
      kept_back_[party].push_back(*i);
      i = jobs.erase(i);
    }
}

void site::freeze(site_party& x) {
  if (!x.alive())
    return;
  auto& ids = frozen_[x.index];
  for (const auto& row : x.context.directory->rows())
    ids.insert(row.id);
}

void site::thaw(site_party& x) {
  frozen_.erase(x.index);
  for (auto* job : std::exchange(kept_back_[x.index], {}))
    time.scheduler.jobs.push_back(job);
}

void site::later(const site_party& x, std::chrono::milliseconds delay,
                 std::function<void()> work) {
  work_.emplace(++last_work_, std::move(work));
  caf::delayed_anon_send(x.edge, delay, caf::tick_atom_v, last_work_);
}

void site::run_work(uint64_t number) {
  if (auto work = work_.extract(number); !work.empty())
    work.mapped()();
}

void site::report_violation(const std::string& what) {
  violations.push_back(what);
}

frame_fate site::decide(const char* what, size_t from, size_t to) {
  ++messages;
  return judge ? judge({messages, what, from, to}) : frame_fate::passed;
}

} // namespace roscell::test
