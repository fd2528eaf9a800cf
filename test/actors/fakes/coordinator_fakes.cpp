#include "test/actors/fakes/coordinator_fakes.hpp"

#include "actors/placement/reservation.hpp"
#include "actors/requests/handler_pipeline.hpp"
#include "test/actors/fakes/planner.hpp"

#include <algorithm>

namespace roscell::test {

namespace {

figures_report metrics_of(const fake_agent& x) {
  figures_report result;
  for (const auto& [id, row] : x.running)
    result.instances.push_back({id, row.status, row.metrics});
  return result;
}

resource_report report_of(const fake_agent& x) {
  auto result = x.has;
  for (const auto& [id, row] : x.running)
    reserve(result, row.spec.resources, row.spec.gpu);
  resource_report report{result, {}};
  for (const auto& request : x.reservations)
    for (const auto& spec : request.specs)
      if (x.reports_reserved && x.running.count(spec.instance) == 0) {
        reserve(report.resources, spec.resources, spec.gpu);
        report.reserved.push_back(spec.instance);
      }
  return report;
}

void on_deployment(caf::event_based_actor* self, fake_agent* x,
                   const instance_spec& spec) {
  // The promise takes the message's sender, so it is looked at before.
  x->deployer = caf::actor_cast<caf::actor>(self->current_sender());
  auto promise = self->make_response_promise();
  x->deployments.push_back(spec);
  if (x->mood == temper::broken)
    return promise.deliver(
        fail(error_code::engine_failed, "the program exited with code 3"));
  if (x->mood == temper::happy)
    return x->bring_up(promise, spec);
  // It is known from the beginning, as with a real supervisor.
  auto row = row_of(spec, x->identity.name, instance_state::starting);
  x->running[spec.instance] = row;
  x->report_row(row);
  x->starting.emplace_back(promise, spec);
}

void on_resource_query(caf::event_based_actor* self, fake_agent* x) {
  auto promise = self->make_response_promise();
  if (x->silent)
    x->unanswered.push_back(promise);
  else if (x->slow_reports)
    x->reports.emplace_back(promise, report_of(*x));
  else
    promise.deliver(report_of(*x));
}

caf::behavior agent(caf::event_based_actor* self, fake_agent* x) {
  return {
      [=](const resource_query&) { on_resource_query(self, x); },
      [=](const instance_reservation& request) {
        x->reservations.push_back(request);
        instances_reserved reply;
        if (x->reluctance > 0) {
          --x->reluctance;
          for (const auto& spec : request.specs)
            reply.refused.push_back({spec.instance, "too busy now"});
        }
        return reply;
      },
      [=](const instance_deployment& request) {
        x->fetches.push_back(request.fetch);
        on_deployment(self, x, request.spec);
      },
      [=](const instance_removal& what) {
        x->removals.push_back(what);
        auto promise = self->make_response_promise();
        if (x->slow_removals)
          x->ending.emplace_back(promise, what);
        else
          x->take_down(promise, what);
      },
      [=](const set_parameters& what) {
        x->changes.push_back(what);
        auto promise = self->make_response_promise();
        if (x->slow_changes)
          x->changing.emplace_back(promise, what.instance);
        else
          promise.deliver(parameters_set{what.instance});
      },
      [=](const instance_query&) {
        instance_description result;
        for (const auto& [id, row] : x->running)
          result.instances.push_back(row);
        return result;
      },
      [=](const contact_proven& event) { x->kept = event.kept; },
      [=](const figures_query&) -> caf::result<figures_report> {
        if (!x->mute)
          return metrics_of(*x);
        x->unanswered.push_back(self->make_response_promise());
        return caf::delegated<figures_report>{};
      },
      [=](const log_query& query) {
        return log_excerpt{query.instance,
                           (query.previous ? "kept by " : "hello from ")
                               + x->identity.name,
                           5, false};
      },
      [=](const kept_logs_query& query) -> caf::result<kept_logs> {
        if (x->mute)
          return fail(error_code::timeout, "it does not answer");
        kept_logs result;
        for (const auto& log : x->logs_kept)
          if (query.instance.empty() || query.instance == log.instance)
            result.logs.push_back(log);
        return result;
      },
      [=](const build_keeping& request) -> caf::result<build_kept> {
        x->keepings.push_back(request);
        if (x->on_keeping)
          x->on_keeping();
        if (x->gets_nothing)
          return fail(error_code::unreachable, "no node gives the build");
        return build_kept{request.offer.build.hash};
      },
      [=](const build_release& request) {
        x->releases.push_back(request.hash);
        return build_released{request.hash};
      },
      [=](const image_query& query) -> caf::result<image_known> {
        const auto known = x->images.find(query.image);
        if (x->mute || known == x->images.end())
          return image_known{};
        return image_known{known->second, 7};
      },
      [=](const image_sharing& request) -> caf::result<image_shared> {
        x->sharings.push_back(request);
        if (x->gets_nothing)
          return fail(error_code::engine_failed, "it cannot be saved");
        return image_shared{x->shared_build};
      },
      [=](const registration_switch& order) {
        x->orders.push_back(order);
        return switch_accepted{order.epoch + 1};
      },
      [=](const close_session& request) {
        x->closed.push_back(request.reason);
      },
      [=](caf::tick_atom) {
        for (const auto& work : std::exchange(x->todo, {}))
          work();
      },
  };
}

void write_all(paper_cell* cell, caf::response_promise promise,
               const store_records& x) {
  for (const auto& record : x.records)
    cell->write(record);
  promise.deliver(record_stored{});
}

void store_in(paper_cell* cell, caf::response_promise promise,
              const store_records& x) {
  if (cell->disk_full)
    promise.deliver(fail(error_code::internal, "the disk is full"));
  else if (cell->slow_disk)
    cell->writes.emplace_back(promise, x);
  else
    write_all(cell, promise, x);
}

caf::behavior disk_of(caf::event_based_actor* self, paper_cell* cell) {
  return {
      [=](const store_record& x) {
        store_in(cell, self->make_response_promise(), {{x}});
      },
      [=](const store_records& x) {
        store_in(cell, self->make_response_promise(), x);
      },
      [=](caf::tick_atom) {
        for (auto& [promise, x] : std::exchange(cell->writes, {}))
          write_all(cell, promise, x);
      },
  };
}

/// The keeper of the coordination node's builds.
caf::behavior builds_of(paper_cell* cell) {
  return {
      [=](const describe_build& x) -> caf::result<build_described> {
        const auto found = cell->kept_builds.find(x.hash);
        if (found == cell->kept_builds.end())
          return fail(error_code::schema_violation, "it is no skill");
        return build_described{{x.hash, x.hash, 7}, found->second};
      },
      [=](const pin_build& x) {
        return build_held{{x.hash, x.hash, 7}, {}, true};
      },
      [=](const drop_build& x) {
        cell->dropped_builds.push_back(x.hash);
        return build_dropped{};
      },
  };
}

caf::behavior keeper(paper_cell* cell) {
  return {
      [=](const record_event& x) {
        cell->events.push_back(
            {x.what, x.subject,
             x.data.empty() ? json::object() : json::parse(x.data)});
      },
  };
}

} // namespace

// -- a node ------------------------------------------------------------------

void fake_agent::report_row(const instance_row& row) {
  caf::send_as(actor, coordinator, instance_changed{row});
}

void fake_agent::bring_up(caf::response_promise promise,
                          const instance_spec& spec) {
  const auto row = row_of(spec, identity.name);
  running[spec.instance] = row;
  report_row(row);
  promise.deliver(instance_deployed{row});
}

void fake_agent::take_down(caf::response_promise promise,
                           const instance_removal& what) {
  instances_removed reply;
  for (auto i = running.begin(); i != running.end();) {
    auto row = i->second;
    if (row.spec.task != what.task
        || (!what.instance.empty() && what.instance != i->first)) {
      ++i;
      continue;
    }
    if (not_stop_safe.count(i->first) > 0 && !what.force) {
      reply.waiting.push_back(
          {i->first, row.spec.task, row.spec.step, identity.name, 1000, 0});
      ++i;
      continue;
    }
    reply.instances.push_back(i->first);
    row.state = instance_state::stopped;
    report_row(row);
    i = running.erase(i);
  }
  for (auto& [waiting, spec] : std::exchange(starting, {}))
    if (spec.task == what.task)
      waiting.deliver(fail(error_code::conflict, "it is being removed"));
    else
      starting.emplace_back(waiting, spec);
  promise.deliver(reply);
}

void fake_agent::become_stop_safe(const std::string& instance) {
  not_stop_safe.erase(instance);
  auto row = running.at(instance);
  row.state = instance_state::stopped;
  running.erase(instance);
  report_row(row);
}

namespace {

void inside(fake_agent& x, std::function<void()> work) {
  x.todo.push_back(std::move(work));
  caf::anon_send(x.actor, caf::tick_atom_v);
}

} // namespace

void fake_agent::finish_starting() {
  inside(*this, [this] {
    for (auto& [promise, spec] : std::exchange(starting, {}))
      bring_up(promise, spec);
  });
}

void fake_agent::finish_changes(const std::optional<failure>& refusal) {
  inside(*this, [this, refusal] {
    for (auto& [promise, instance] : std::exchange(changing, {}))
      if (refusal)
        promise.deliver(to_error(*refusal));
      else
        promise.deliver(parameters_set{instance});
  });
}

void fake_agent::fail_starting(const std::string& reason) {
  inside(*this, [this, reason] {
    for (auto& [promise, spec] : std::exchange(starting, {})) {
      running.erase(spec.instance);
      promise.deliver(fail(error_code::engine_failed, reason));
    }
  });
}

void fake_agent::report_metrics() {
  inside(*this, [this] {
    for (auto& promise : std::exchange(unanswered, {}))
      promise.deliver(metrics_of(*this));
  });
}

void fake_agent::finish_reports() {
  inside(*this, [this] {
    for (auto& [promise, report] : std::exchange(reports, {}))
      promise.deliver(report);
  });
}

void fake_agent::finish_removals() {
  inside(*this, [this] {
    for (auto& [promise, what] : std::exchange(ending, {}))
      take_down(promise, what);
  });
}

void fake_agent::fail_removals() {
  inside(*this, [this] {
    for (auto& [promise, what] : std::exchange(ending, {}))
      promise.deliver(fail(error_code::unreachable, "it is out of reach"));
  });
}

// -- the cell ----------------------------------------------------------------

paper_cell::paper_cell(const std::vector<task_record>& tasks,
                       const std::vector<instance_row>& on_base)
    : base(make_agent("base")) {
  event_collector = time.system.spawn([this] { return keeper(this); });
  store = time.system.spawn(disk_of, this);
  build_store = time.system.spawn([this] { return builds_of(this); });
  context = time.context;
  context.events = caf::actor_cast<event_log_actor>(event_collector);
  searches = std::make_shared<search_guard>();
  planner = spawn_planner(time.system, context, searches);
  start_parts(setup(tasks, on_base));
}

void paper_cell::begin_anew() {
  time.kill(router);
  time.kill(coordinator);
  writes.clear();
  std::vector<task_record> tasks;
  for (const auto& [task, record] : disk)
    tasks.push_back(record.get<task_record>());
  auto how = setup(tasks, {});
  how.incarnation = 4;
  for (const auto& [uuid, record] : members)
    how.members.push_back(record.get<member_record>());
  for (const auto& [uuid, record] : drains)
    how.drains.push_back(record.get<drain_record>());
  for (const auto& [hash, record] : builds)
    how.builds.push_back(record.get<cell_build>());
  for (const auto& [name, record] : sets)
    how.sets.push_back(record.get<task_set_record>());
  for (const auto& [hash, record] : remains)
    how.remains.push_back(record.get<build_remains>());
  start_parts(how);
}

void paper_cell::start_parts(const coordinator_setup& how) {
  coordinator = spawn(time.system, context, cell_coordinator, context, how);
  for (const auto& x : agents)
    x->coordinator = coordinator;
  auto services = std::make_shared<node_services>();
  services->context = context;
  services->coordinator = coordinator;
  services->scheduler = planner;
  router = spawn(time.system, context, request_router,
                 std::make_shared<const request_registry>(make_registry(true)),
                 std::shared_ptr<const node_services>(services));
  caf::anon_send(coordinator, use_router{router});
  time.settle();
}

paper_cell::~paper_cell() {
  // The longest wait of a request is 15 min; a few may follow each other.
  for (int i = 0; i < 4; ++i) {
    time.scheduler.clock().advance_time(1h);
    time.settle();
  }
  for (const auto& x : agents) {
    x->starting.clear();
    x->reports.clear();
    x->ending.clear();
    x->unanswered.clear();
    x->deployer = nullptr;
    x->coordinator = nullptr;
    time.kill(x->actor);
  }
  writes.clear();
  time.kill(router);
  time.kill(coordinator);
  time.kill(planner);
  time.kill(store);
  time.kill(build_store);
  time.kill(event_collector);
}

coordinator_setup paper_cell::setup(const std::vector<task_record>& tasks,
                                    const std::vector<instance_row>& on_base) {
  coordinator_setup result;
  result.cell = "lab";
  result.discovery_server = "10.0.0.1:11811";
  result.incarnation = 3;
  result.self = base.identity;
  result.skills = {echo_skill()};
  result.agent = caf::actor_cast<node_agent_actor>(base.actor);
  result.supervisor = caf::actor_cast<container_supervisor_actor>(base.actor);
  result.environment = {{"ROS_DOMAIN_ID", "7"}};
  result.ros2_set_parameters = ros2_set_parameters;
  result.require_signed_skills = require_signed_skills;
  result.check_signature =
      [](const std::string& hash,
         const std::string& signature) -> std::variant<std::string, failure> {
    if (signature == "ada " + hash)
      return std::string{"spiffe://hall/operator/ada/0a"};
    return failure{error_code::unauthorized, "no such signature"};
  };
  result.store = caf::actor_cast<state_store_actor>(store);
  result.keeper = caf::actor_cast<build_keeper_actor>(build_store);
  result.build_key = "key of base";
  result.searches = searches;
  result.scheduler = planner;
  result.tasks = tasks;
  for (const auto& row : on_base)
    base.running[row.spec.instance] = row;
  for (const auto& x : tasks)
    disk[x.task] = x;
  return result;
}

fake_agent& paper_cell::make_agent(const std::string& name) {
  agents.push_back(std::make_unique<fake_agent>());
  auto* x = agents.back().get();
  x->identity = {name, "uuid-of-" + name, 1, "10.0.0.9:8420"};
  x->skills = {echo_skill()};
  x->has.name = name;
  x->has.architecture = "amd64";
  x->has.cpu = {4, 0};
  x->has.memory_mib = {1000, 0};
  x->has.disk_mib = {1000, 0};
  x->has.labels = {{"is", name}};
  x->actor = time.system.spawn(agent, x);
  x->member = caf::actor_cast<member_actor>(x->actor);
  x->coordinator = coordinator;
  return *x;
}

fake_agent& paper_cell::add(const std::string& name) {
  auto& x = make_agent(name);
  REQUIRE(enter(x));
  return x;
}

caf::expected<node_registered> paper_cell::enter(fake_agent& x) {
  node_registration registration;
  registration.identity = x.identity;
  registration.incarnation = 3;
  registration.resources = report_of(x).resources;
  registration.skills = x.skills;
  registration.fetches_builds = x.fetches_builds;
  for (const auto& [id, row] : x.running)
    registration.instances.push_back(row);
  auto reply = time.ask<node_registered>(coordinator,
                                         register_node{registration, x.member});
  time.settle();
  return reply->value();
}

void paper_cell::lose(fake_agent& x) {
  caf::anon_send(coordinator, member_lost{x.identity.uuid, x.member, "gone"});
  time.settle();
}

void paper_cell::depart(fake_agent& x) {
  auto reply = time.ask<node_departed>(
      coordinator, depart_node{x.identity.uuid, x.member, "shut down"});
  time.settle();
  REQUIRE(reply->value());
}

json paper_cell::request_text(const std::string& text) {
  auto reply = time.ask<request_routed>(router, route_request{text});
  time.settle();
  return reply_of(reply);
}

json paper_cell::request(const json& document) {
  return request_text(document.dump());
}

pending_reply paper_cell::post(const json& document) {
  auto reply = time.ask<request_routed>(router, route_request{document.dump()});
  time.settle();
  return reply;
}

registry_row paper_cell::row(const std::string& node) {
  auto reply = time.ask<cell_description>(coordinator, cell_query{});
  time.settle();
  for (const auto& x : (*reply)->value().nodes)
    if (x.identity.name == node)
      return x;
  return {};
}

json paper_cell::tasks() {
  return request({{"type", "task_query"}}).at("tasks");
}

void paper_cell::write(const store_record& x) {
  auto* table = x.table == "tasks"            ? &disk
                : x.table == "history"        ? &history
                : x.table == "drains"         ? &drains
                : x.table == "members"        ? &members
                : x.table == "builds"         ? &builds
                : x.table == "task_sets"      ? &sets
                : x.table == "removed_builds" ? &remains
                                              : nullptr;
  if (table == nullptr)
    return;
  if (x.value.empty())
    table->erase(x.key);
  else
    (*table)[x.key] = json::parse(x.value);
}

void paper_cell::finish_writes() {
  caf::anon_send(store, caf::tick_atom_v);
}

size_t paper_cell::count(const std::string& event) const {
  return static_cast<size_t>(
      std::count_if(events.begin(), events.end(),
                    [&](const auto& x) { return x.what == event; }));
}

// -- what is said ------------------------------------------------------------

json reply_of(const pending_reply& x) {
  if (!*x)
    return nullptr;
  return json::parse((*x)->value().text);
}

std::string error_of(const json& reply) {
  return reply.is_object() && reply.at("type") == "error"
             ? reply.at("error").at("code").get<std::string>()
             : "";
}

installed_skill grasp_skill() {
  auto result = echo_skill();
  result.descriptor.operation = "grasp";
  result.descriptor.safe_state = true;
  result.hash.assign(64, 'b');
  return result;
}

installed_skill echo_skill() {
  skill_descriptor result;
  result.operation = "echo";
  result.engine = "primitive";
  result.entry_point = {"bin/echo"};
  result.input = {{"text/plain"}, {"file"}};
  result.output = {{"text/plain"}, {"file"}};
  implementation_model model{"plain", R"({"shout":false,"times":2})", {}};
  for (int cores = 1; cores <= 4; ++cores) {
    deployment_option option;
    option.name = "cpu-" + std::to_string(cores);
    option.base_image = "debian:bookworm-slim";
    option.architectures = {"amd64"};
    option.resources = {static_cast<double>(cores), 100, 10};
    option.environment = {{"OMP_NUM_THREADS", "1"}, {"ROS_DOMAIN_ID", "8"}};
    model.deployments.push_back(option);
  }
  result.models = {model};
  return {std::string(64, 'a'), result};
}

json placement_in(json accepted) {
  accepted.erase("found");
  return accepted;
}

json echo_step(const std::string& id, int cores, const std::string& node) {
  json step{{"id", id},
            {"operation", "echo"},
            {"model", "plain"},
            {"deployment", "cpu-" + std::to_string(cores)}};
  if (!node.empty())
    step["labels"] = {{"is", node}};
  return step;
}

json echo_task(const std::string& task, const std::vector<json>& steps) {
  return {{"type", "task_request"}, {"task", task}, {"pipeline", steps}};
}

json termination(const std::string& task, bool force) {
  json result{{"type", "task_termination"}, {"task", task}};
  if (force)
    result["force"] = true;
  return result;
}

instance_spec echo_instance(const std::string& instance,
                            const std::string& task, const std::string& step) {
  instance_spec result;
  result.instance = instance;
  result.task = task;
  result.step = step;
  result.operation = "echo";
  result.model = "plain";
  result.deployment = "cpu-1";
  result.parameters = "{}";
  result.resources = {1, 100, 10};
  return result;
}

task_record kept_record(const std::vector<instance_spec>& specs,
                        const std::vector<std::string>& nodes,
                        task_state state) {
  task_record result;
  result.task = specs.at(0).task;
  result.request = "{}";
  result.accepted = R"({"type":"task_accepted"})";
  result.state = state;
  result.specs = specs;
  result.nodes = nodes;
  return result;
}

instance_row row_of(const instance_spec& spec, const std::string& node,
                    instance_state state) {
  instance_row row;
  row.spec = spec;
  row.node = node;
  row.state = state;
  return row;
}

} // namespace roscell::test
