#include "test/actors/fakes/cell_fakes.hpp"

#include <utility>

namespace roscell::test {

namespace {

constexpr auto server = "10.0.0.1:11811";
constexpr auto sessions = "10.0.0.1:8420";

// -- the coordination node ---------------------------------------------------

void accept(fake_site* site, const session_admitted& event) {
  site->base.members.push_back(roscell::spawn(site->time.system, site->context,
                                              member, event, site->base.actor));
}

node_registered answer_of(const fake_coordinator& base) {
  return {base.cell,     base.name,         base.incarnation,
          base.verdicts, base.cell_uuid,    base.discovery,
          false,         base.hears_skills, base.build_key};
}

caf::result<node_registered> enter(fake_site* site, const register_node& x) {
  auto& base = site->base;
  if (base.refusal)
    return to_error(*base.refusal);
  const auto& who = x.registration.identity;
  auto& row = base.rows[who.name];
  if (!row.identity.uuid.empty() && row.identity.uuid != who.uuid)
    return fail(error_code::conflict,
                "the name '" + who.name + "' belongs to another node");
  if (who.epoch < row.identity.epoch)
    return fail(error_code::conflict, "an old epoch");
  if (row.member && row.member != x.member)
    caf::anon_send(row.member, close_session{"it has registered again"});
  row = {who, x.member, true, "", x.registration};
  return answer_of(base);
}

node_departed drop(fake_site* site, const depart_node& x) {
  auto& rows = site->base.rows;
  for (auto i = rows.begin(); i != rows.end(); ++i) {
    if (i->second.member == x.member) {
      rows.erase(i);
      break;
    }
  }
  return {};
}

void lose(fake_site* site, const member_lost& event) {
  site->base.losses.push_back(event);
  for (auto& [name, row] : site->base.rows) {
    if (row.member == event.member) {
      row.active = false;
      row.reason = event.reason;
    }
  }
}

caf::behavior coordinator(caf::event_based_actor* self, fake_site* site) {
  return {
      [=](const session_admitted& event) { accept(site, event); },
      [=](const register_node& x) -> caf::result<node_registered> {
        if (!site->base.mute)
          return enter(site, x);
        auto promise = self->make_response_promise();
        site->base.unanswered.push_back(promise);
        return promise;
      },
      [=](caf::ok_atom) {
        auto& base = site->base;
        for (auto& promise : std::exchange(base.unanswered, {}))
          promise.deliver(answer_of(base));
      },
      [=](const depart_node& x) { return drop(site, x); },
      [=](const member_lost& event) { lose(site, event); },
      [=](const instance_changed& x) { site->base.changes.push_back(x); },
      [=](const member_skills_changed& x) { site->base.skills.push_back(x); },
      [=](const image_request& x) {
        site->base.image_requests.push_back(x);
        image_offered offer;
        offer.image_id = "sha256:" + std::string(64, 'b');
        offer.node = "arm-2";
        offer.cell = site->base.cell;
        const std::string hash(64, 'c');
        offer.offer.build = {hash, hash, 7};
        return offer;
      },
      [=](const route_request& x) {
        site->base.asked.push_back(json::parse(x.text));
        return request_routed{site->base.answer.dump(), ""};
      },
  };
}

// -- the parts of a node -----------------------------------------------------

coordinator_found announcement(const fake_coordinator& base) {
  return {base.cell, base.name, sessions, base.incarnation};
}

caf::result<session_opened> connect(fake_site* site, fake_node* node,
                                    const open_session& x) {
  auto& base = site->base;
  if (node->refusal)
    return to_error(*node->refusal);
  if (!base.actor)
    return fail(error_code::unreachable, "connection refused");
  node->link =
      make_wire(site->time.system, site->context, site->random, site->faults);
  caf::anon_send(base.actor, session_admitted{node->link->ends[0], x.self});
  return session_opened{node->link->ends[1], base.cell, base.name,
                        base.incarnation};
}

caf::result<record_stored> store(fake_node* node, const store_records& xs) {
  if (node->disk_full)
    return fail(error_code::internal, "the disk is full");
  for (const auto& x : xs.records)
    if (x.key == "node")
      node->identity = json::parse(x.value).get<node_identity>();
  return record_stored{};
}

caf::result<instance_deployed> deploy(caf::event_based_actor* self,
                                      fake_node* node,
                                      const instance_deployment& x) {
  node->deployments.push_back(x);
  if (node->deployment_refusal)
    return to_error(*node->deployment_refusal);
  instance_row row;
  row.spec = x.spec;
  row.node = "what-it-likes";
  row.state = instance_state::running;
  auto promise = self->make_response_promise();
  node->deploying.emplace_back(promise, row);
  self->delayed_send(self, node->deployment_takes, caf::ok_atom_v);
  return promise;
}

instances_removed remove(fake_node* node, const instance_removal& x) {
  node->removals.push_back(x);
  return {{x.instance}};
}

caf::result<host_resolved> look_up(fake_node* node, const resolve_host& x) {
  const auto known = node->names.find(x.host);
  if (known == node->names.end())
    return fail(error_code::unreachable,
                "the name '" + x.host + "' does not resolve");
  return host_resolved{known->second};
}

caf::behavior local_parts(caf::event_based_actor* self, fake_site* site,
                          fake_node* node) {
  return {
      [=](const resolve_host& x) { return look_up(node, x); },
      [=](const probe_server&) {
        ++node->looks;
        return node->probed;
      },
      [=](const find_coordinator& x) {
        node->sought.push_back(x.address);
        node->searching = true;
        ++node->searches;
        if (site->base.actor && x.address != site->unauthenticated_server)
          self->delayed_send(self, 100ms, caf::tick_atom_v);
        return caf::ok_atom_v;
      },
      [=](caf::tick_atom) {
        if (node->searching && site->base.actor
            && node->sought.back() != site->unauthenticated_server)
          self->send(node->membership, announcement(site->base));
      },
      [=](const forget_coordinator&) { node->searching = false; },
      [=](const serve_programs& x) -> caf::result<programs_served> {
        if (node->serving_refusal)
          return to_error(*node->serving_refusal);
        node->served = x;
        const auto port = x.port != 0 ? x.port : 11811;
        return programs_served{"10.0.0.9:" + std::to_string(port)};
      },
      [=](const stop_serving&) { node->served.reset(); },
      [](const follow_server&) { return caf::ok_atom_v; },
      [=](const use_environment& x) {
        node->environment = x.environment;
        ++node->environments;
      },
      // Nobody else is on this site.
      [=](const announce_presence&) { ++node->announcements; },
      [](const withdraw_presence&) {
        // The same.
      },
      [=](const open_session& x) { return connect(site, node, x); },
      [=](const store_record& x) { return store(node, {{x}}); },
      [=](const store_records& x) { return store(node, x); },
      [=](const resource_query&) {
        return resource_report{some_resources("what-it-likes")};
      },
      [=](const instance_query&) {
        return instance_description{node->instances};
      },
      [](const figures_query&) {
        figures_report result;
        result.instances.push_back({"t-a-1", "frames=7", {7, 2.5, 0, 1.5}});
        return result;
      },
      [](const contact_proven&) {},
      [](const contact_lost&) {},
      [=](const ends_acknowledged& x) {
        auto& known = node->acknowledged;
        known.insert(known.end(), x.instances.begin(), x.instances.end());
      },
      [=](const instance_reservation& x) {
        node->reservations.push_back(x);
        return instances_reserved{{{"t-b-1", "no room"}}};
      },
      [=](const instance_deployment& x) { return deploy(self, node, x); },
      [=](caf::ok_atom) {
        auto& [promise, row] = node->deploying.front();
        promise.deliver(instance_deployed{row});
        node->deploying.pop_front();
      },
      [=](const instance_removal& x) { return remove(node, x); },
      [=](const log_query& x) -> caf::result<log_excerpt> {
        if (x.instance == "unknown")
          return fail(error_code::unknown_task, "no such instance",
                      "/instance");
        return log_excerpt{x.instance, "a line\n", 7, true};
      },
      [=](const kept_logs_query& x) {
        kept_log log;
        log.instance = x.instance;
        log.node = "name-of-before";
        return kept_logs{{log}};
      },
  };
}

} // namespace

// -- the site ----------------------------------------------------------------

fake_site::fake_site(virtual_time& clock, uint32_t seed)
    : time(clock), random(seed), context(clock.context) {
  event_collector =
      time.system.spawn([this](caf::event_based_actor*) -> caf::behavior {
        return {[this](const record_event& x) {
          events.push_back({x.what, x.subject, json::parse(x.data)});
        }};
      });
  context.events = caf::actor_cast<event_log_actor>(event_collector);
}

fake_site::~fake_site() {
  for (auto& node : nodes)
    kill(*node);
  kill_coordinator();
  time.kill(event_collector);
  time.scheduler.clock().cancel_all();
}

void fake_site::pass(std::chrono::milliseconds span) {
  timers_fired += time.pass(span);
}

void fake_site::start_coordinator() {
  base.actor = caf::actor_cast<cell_coordinator_actor>(
      time.system.spawn(coordinator, this));
  announce();
}

void fake_site::kill_coordinator() {
  if (!base.actor)
    return;
  time.kill(std::exchange(base.actor, nullptr));
  // Its members die with it, and the kernel closes their connections.
  for (auto& member : std::exchange(base.members, {}))
    time.kill(member);
  base.unanswered.clear();
  base.rows.clear();
  ++base.incarnation;
}

void fake_site::announce() {
  for (auto& node : nodes)
    if (node->local)
      caf::anon_send(node->local, caf::tick_atom_v);
}

void fake_site::announce_to(fake_node& x) {
  caf::anon_send(x.membership, announcement(base));
}

fake_node& fake_site::add_node(const std::string& name,
                               const std::string& uuid) {
  nodes.push_back(std::make_unique<fake_node>());
  nodes.back()->identity = {name, uuid, 0, "10.0.0.7:8420"};
  return *nodes.back();
}

void fake_site::start(fake_node& x) {
  x.local = time.system.spawn(local_parts, this, &x);
  membership_parts parts;
  parts.discovery = caf::actor_cast<discovery_actor>(x.local);
  parts.connector = caf::actor_cast<session_connector_actor>(x.local);
  parts.agent = caf::actor_cast<node_agent_actor>(x.local);
  parts.supervisor = caf::actor_cast<container_supervisor_actor>(x.local);
  parts.store = caf::actor_cast<state_store_actor>(x.local);
  parts.diagnoser = caf::actor_cast<join_diagnoser_actor>(x.local);
  membership_config config{x.identity, {}};
  config.site = site_token;
  config.claim_address = [&x] { ++x.claims; };
  x.membership = roscell::spawn(time.system, context, membership, context,
                                parts, std::move(config));
}

void fake_site::kill(fake_node& x) {
  if (!x.local)
    return;
  time.kill(std::exchange(x.membership, nullptr));
  time.kill(std::exchange(x.local, nullptr));
  x.searching = false;
  x.deploying.clear();
  // A wire whose session nobody has taken yet.
  if (x.link)
    cut(*x.link);
  time.settle();
}

void fake_site::join(fake_node& x) {
  caf::anon_send(x.membership, join_cell{server});
}

membership_state fake_site::status(fake_node& x) {
  auto result = time.ask<membership_state>(x.membership, membership_query{});
  time.settle();
  return *result->value();
}

size_t fake_site::count(const std::string& event) const {
  return static_cast<size_t>(
      std::count_if(events.begin(), events.end(),
                    [&](const auto& x) { return x.what == event; }));
}

// -- samples -----------------------------------------------------------------

node_resources some_resources(const std::string& node) {
  node_resources result;
  result.name = node;
  result.architecture = "amd64";
  result.cpu = {4, 0.5};
  result.memory_mib = {8192, 1024};
  result.disk_mib = {100'000, 10'000};
  return result;
}

instance_spec some_spec(const std::string& instance, const std::string& task) {
  instance_spec result;
  result.instance = instance;
  result.task = task;
  result.step = "poses";
  result.operation = "pose_estimation";
  result.model = "apriltag3";
  result.deployment = "cpu";
  result.skill = std::string(64, 'a');
  result.cell = "cell-1";
  result.resources = {1, 96, 150, -1};
  return result;
}

instance_row some_row(const std::string& instance, const std::string& task) {
  instance_row result;
  result.spec = some_spec(instance, task);
  result.node = "arm-1";
  result.state = instance_state::running;
  return result;
}

} // namespace roscell::test
