#include "test/site/site.hpp"

#include <caf/actor_cast.hpp>

#include <algorithm>
#include <utility>

namespace roscell::test {

namespace {

/// A public announcement travels for so long, and the answer of a discovery
/// server.
constexpr auto presence_delay = 20ms;

/// Somebody who was killed is seen for so long, at least. It is ten minutes in
/// production; nothing depends on it but how long a test takes.
constexpr auto ghost_span = 15s;

std::pair<size_t, size_t> ordered(size_t x, size_t y) {
  return {std::min(x, y), std::max(x, y)};
}

template <class Handle>
Handle part(const site_party& x) {
  return caf::actor_cast<Handle>(x.edge);
}

std::string record(const site_party& x, const std::string& table,
                   const std::string& key) {
  const auto records = x.disk.find(table);
  if (records == x.disk.end())
    return {};
  const auto i = records->second.find(key);
  return i == records->second.end() ? std::string{} : i->second;
}

node_identity identity_on_disk(const site_party& x) {
  const auto known = record(x, "identity", "node");
  auto result =
      known.empty() ? node_identity{} : json::parse(known).get<node_identity>();
  result.name = x.name;
  result.uuid = x.uuid;
  result.address = x.address;
  return result;
}

membership_config membership_setup(const site_party& x) {
  membership_config result;
  result.identity = identity_on_disk(x);
  result.configured = x.configured;
  result.site_token = site_token;
  if (const auto known = record(x, "identity", "membership"); !known.empty())
    result.restored = json::parse(known).get<membership_record>();
  return result;
}

/// Starts the membership as actors/node/node_builder.cpp does.
void start_membership(site& place, site_party& x) {
  membership_parts parts;
  parts.discovery = part<discovery_actor>(x);
  parts.connector = part<session_connector_actor>(x);
  parts.agent = part<node_agent_actor>(x);
  parts.supervisor = part<container_supervisor_actor>(x);
  parts.store = part<state_store_actor>(x);
  const auto config = membership_setup(x);
  x.membership =
      spawn(place.time.system, x.context, membership, x.context, parts, config);
  if (takes_up_earlier_cell(config) || x.configured == "wait")
    return;
  if (x.configured.empty())
    caf::anon_send(x.membership, seek_cell{});
  else
    caf::anon_send(x.membership, join_cell{x.configured});
}

void start_coordinator(site& place, site_party& x) {
  const auto known = record(x, "identity", "incarnation");
  coordinator_setup setup;
  setup.incarnation = known.empty() ? 1 : std::stoll(known) + 1;
  x.disk["identity"]["incarnation"] = std::to_string(setup.incarnation);
  setup.cell = x.cell;
  setup.discovery_server = x.discovery_server;
  setup.self = identity_on_disk(x);
  setup.agent = part<node_agent_actor>(x);
  setup.store = part<state_store_actor>(x);
  setup.discovery = part<discovery_actor>(x);
  setup.connector = part<session_connector_actor>(x);
  setup.registration = part<registration_client_actor>(x);
  for (const auto& [key, value] : x.disk["members"])
    setup.members.push_back(json::parse(value).get<member_record>());
  for (const auto& [key, value] : x.disk["transfers"])
    setup.transfers.push_back(json::parse(value).get<transfer_row>());
  x.coordinator =
      spawn(place.time.system, x.context, cell_coordinator, x.context, setup);
}

} // namespace

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
  for (const auto& x : fact_keepers_)
    time.kill(x);
  time.scheduler.clock().cancel_all();
}

void site::keep_facts(site_party& x) {
  fact_keepers_.push_back(time.system.spawn(
      [this, &x](caf::event_based_actor* self) -> caf::behavior {
        return {[this, &x, self](const record_event& fact) {
          const auto when =
              std::chrono::duration_cast<std::chrono::milliseconds>(
                  self->clock().now() - start_);
          auto data =
              fact.data.empty() ? json::object() : json::parse(fact.data);
          facts.push_back({when, x.index, x.life, fact.what, fact.subject,
                           std::move(data)});
        }};
      }));
  x.context = context;
  x.context.events = caf::actor_cast<event_log_actor>(fact_keepers_.back());
}

site_party& site::add_party(const std::string& name) {
  auto& x = *parties.emplace_back(std::make_unique<site_party>());
  x.index = parties.size() - 1;
  const auto number = std::to_string(x.index);
  x.name = name + "-" + number;
  x.address = "10.0.0." + number + ":8420";
  keep_facts(x);
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
  x.edge = time.system.spawn(site_edge, this, &x);
  if (!x.coordinates)
    return start_membership(*this, x);
  start_coordinator(*this, x);
  for (auto& other : parties)
    if (other->looking_for == x.discovery_server)
      look_up(*other);
}

void site::kill(site_party& x) {
  if (!x.alive())
    return;
  std::vector<caf::actor> doomed{x.brain(), x.edge};
  for (const auto& c : connections)
    for (size_t end = 0; end < 2; ++end)
      if (c.parties[end] == x.index)
        if (auto owner = caf::actor_cast<caf::actor>(c.link->owners[end]))
          doomed.push_back(owner);
  // All at once, so that none has time for last words.
  for (const auto& actor : doomed)
    caf::anon_send_exit(actor, caf::exit_reason::kill);
  x.edge = nullptr;
  x.coordinator = nullptr;
  x.membership = nullptr;
  x.looking_for.clear();
  x.announced.reset();
  x.shown.clear();
  for (auto& request : requests)
    request.closed |= request.asked == x.index;
  // The kernel closes what had no owner yet.
  for (const auto& c : connections)
    for (size_t end = 0; end < 2; ++end)
      if (c.parties[end] == x.index && !c.link->owners[end])
        caf::anon_send(c.link->ends[end], close_session{"the peer has ended"});
  for (auto& viewer : parties)
    fade(*viewer, x.index, ghost_span + std::chrono::seconds{pick(30)});
  time.settle();
}

// -- time --------------------------------------------------------------------

bool site::pass_until(std::chrono::milliseconds span,
                      const std::function<bool()>& stop) {
  auto& clock = time.scheduler.clock();
  const auto end = clock.now() + span;
  for (;;) {
    while (time.scheduler.try_run_once())
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

void site::later(const site_party& x, std::chrono::milliseconds delay,
                 std::function<void()> work) {
  work_.emplace(++last_work_, std::move(work));
  caf::delayed_anon_send(x.edge, delay, caf::tick_atom_v, last_work_);
}

void site::run_work(uint64_t number) {
  if (auto work = work_.extract(number); !work.empty())
    work.mapped()();
}

frame_fate site::decide(const char* what, size_t from, size_t to) {
  ++messages;
  return judge ? judge({messages, what, from, to}) : frame_fate::passed;
}

// -- who reaches and sees whom -----------------------------------------------

bool site::reachable(size_t x, size_t y) const {
  return sides_.empty() || sides_[x] == sides_[y];
}

bool site::sees(const site_party& viewer, const site_party& subject) const {
  const auto x = viewer.index;
  const auto y = subject.index;
  return reachable(x, y) && hidden_.count(ordered(x, y)) == 0;
}

void site::split(const std::vector<int>& sides) {
  sides_ = sides;
  for (auto& c : connections) {
    if (reachable(c.parties[0], c.parties[1]))
      heal(*c.link);
    else
      c.link->silent = true;
  }
  spread();
  for (auto& x : parties)
    look_up(*x);
}

void site::block(size_t x, size_t y) {
  blocked_.insert(ordered(x, y));
}

void site::hide(size_t x, size_t y) {
  hidden_.insert(ordered(x, y));
}

void site::heal_all() {
  blocked_.clear();
  hidden_.clear();
  split({});
}

void site::show(site_party& viewer, const site_party& subject) {
  const auto what = *subject.announced;
  auto& known = viewer.shown[subject.index];
  if (known == what)
    return;
  known = what;
  later(viewer, presence_delay, [&viewer, who = subject.index, what] {
    const auto i = viewer.shown.find(who);
    if (i != viewer.shown.end() && i->second == what)
      caf::anon_send(viewer.brain(), presence_seen{what});
  });
}

void site::fade(site_party& viewer, size_t subject,
                std::chrono::milliseconds delay) {
  auto known = viewer.shown.extract(subject);
  if (known.empty())
    return;
  later(viewer, delay, [&viewer, subject, what = known.mapped()] {
    if (viewer.announced && viewer.shown.count(subject) == 0)
      caf::anon_send(viewer.brain(), presence_gone{what});
  });
}

void site::spread() {
  for (auto& viewer : parties) {
    if (!viewer->announced)
      continue;
    for (const auto& subject : parties)
      if (subject != viewer && subject->announced && sees(*viewer, *subject))
        show(*viewer, *subject);
  }
}

void site::withdraw(site_party& x) {
  if (!std::exchange(x.announced, std::nullopt))
    return;
  x.shown.clear();
  for (auto& viewer : parties)
    fade(*viewer, x.index,
         sees(*viewer, x) ? std::chrono::milliseconds{presence_delay}
                          : std::chrono::milliseconds{ghost_span});
}

void site::look_up(site_party& x) {
  if (x.looking_for.empty())
    return;
  later(x, 115ms, [this, &x, wanted = x.looking_for] {
    for (const auto& c : parties)
      if (x.looking_for == wanted && c->discovery_server == wanted && c->alive()
          && reachable(x.index, c->index))
        caf::anon_send(x.membership,
                       coordinator_found{c->cell, c->name, c->address,
                                         c->cell_state().setup.incarnation});
  });
}

site_party* site::find_address(const std::string& address) {
  for (const auto& x : parties)
    if (x->address == address)
      return x.get();
  return nullptr;
}

wire_ptr site::connect(const site_party& from, const site_party& to) {
  const auto blocked = blocked_.count(ordered(from.index, to.index)) > 0;
  if (!to.alive() || blocked || !reachable(from.index, to.index))
    return nullptr;
  auto link = make_wire(time.system, context, random, faults);
  link->judge = [this, who = std::array{to.index, from.index}](size_t end) {
    return decide("frame", who[end], who[1 - end]);
  };
  connections.erase(std::remove_if(connections.begin(), connections.end(),
                                   [](const auto& c) {
                                     return !c.link->open && !c.link->silent;
                                   }),
                    connections.end());
  connections.push_back({link, {to.index, from.index}});
  return link;
}

} // namespace roscell::test
