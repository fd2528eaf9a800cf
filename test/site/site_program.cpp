#include "test/site/site_program.hpp"

#include "messages/failure.hpp"
#include "test/site/site.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace roscell::test {

namespace {

using time_point = site_program::time_point;
using milliseconds = std::chrono::milliseconds;

/// A skill says that it lives twice in the time that it has for it.
constexpr auto heartbeat = 5s;

constexpr int terminated_code = 143;
constexpr int killed_code = 137;

site_program* find(site_party& x, const std::string& instance) {
  const auto i = x.programs.find(instance);
  return i == x.programs.end() ? nullptr : &i->second;
}

site_program* find_running(const site& place, site_party& x,
                           const std::string& container) {
  for (auto& [instance, program] : x.programs)
    if (program.container == container && program.runs(place.now()))
      return &program;
  return nullptr;
}

void notify_listener(const site_party& x, const instance_notified& event) {
  if (x.listener)
    caf::anon_send(x.listener, event);
}

/// What the shim writes down.
void write_end(site& place, site_program& program, int exit_code) {
  program.ended = true;
  program.exit_code = exit_code;
  program.ends_at.reset();
  if (exit_code == 0 && program.ready_at)
    place.finished.insert(program.instance);
}

/// The moment of a clock of the boot.
time_point moment_of(int64_t boot_ms) {
  const time_point begin{};
  return begin + milliseconds{boot_ms - virtual_time::boot_ms_at_start};
}

/// How one has ended that nobody has stopped.
int own_exit_code(const site_program& program) {
  const bool fenced =
      program.fence && (!program.ends_at || *program.fence < *program.ends_at);
  return fenced ? killed_code : static_cast<int>(program.script.exit_code);
}

/// It has come to its end by itself.
void finish(site& place, site_party& x, site_program& program) {
  write_end(place, program, own_exit_code(program));
  if (x.listener)
    caf::anon_send(x.listener,
                   container_exited{program.instance, program.container,
                                    program.exit_code});
}

milliseconds until(const site& place, time_point when) {
  return std::chrono::duration_cast<milliseconds>(
      std::max(when - place.now(), time_point::duration{0}));
}

void say_alive(site& place, site_party& x, const std::string& container) {
  auto* program = find_running(place, x, container);
  if (!program)
    return;
  notify_listener(x, {program->instance, true, true, false, ""});
  place.later(x, heartbeat,
              [&place, &x, container] { say_alive(place, x, container); });
}

/// Its shim looks at the fence when it is due, and again if it has moved on.
/// The virtual clock waits whole milliseconds, so the rest of one is rounded
/// up.
void watch_fence(site& place, site_party& x, const site_program& program) {
  if (!program.fence)
    return;
  place.later(x, until(place, *program.fence) + milliseconds{1},
              [&place, &x, container = program.container] {
                for (auto& [instance, known] : x.programs) {
                  if (known.container != container || known.ended)
                    continue;
                  if (place.now() < *known.fence)
                    watch_fence(place, x, known);
                  else
                    finish(place, x, known);
                }
              });
}

/// Lets the program do what its script says, as long as this life of the
/// party's process lasts.
void watch(site& place, site_party& x, const site_program& program) {
  const auto container = program.container;
  watch_fence(place, x, program);
  if (program.ready_at)
    place.later(x, until(place, *program.ready_at),
                [&place, &x, container] { say_alive(place, x, container); });
  if (program.ends_at)
    place.later(x, until(place, *program.ends_at), [&place, &x, container] {
      for (auto& [instance, known] : x.programs)
        if (known.container == container && !known.ended)
          finish(place, x, known);
    });
}

/// Whether an instance was ordered while its cell still had the other node:
/// where somebody wants a move, the new one is begun beside the old one.
bool was_ordered_before_loss(const site& place, const site_party& me,
                             const std::string& instance,
                             const std::string& lost) {
  std::optional<std::chrono::milliseconds> ordered;
  std::optional<std::chrono::milliseconds> loss;
  for (const auto& x : place.events)
    if (x.subject == lost
        && (x.what == "node_lost" || x.what == "transfer_ended"))
      loss = x.when;
    else if (x.party == me.index && x.subject == instance && !ordered)
      ordered = x.when;
  return ordered && loss && *ordered < *loss;
}

/// What may run on a node that its cell has lost is not started elsewhere.
void check_others(site& place, const site_party& me,
                  const start_container& request) {
  const auto& cell = request.labels.at("cell");
  for (const auto& x : place.parties)
    for (const auto& [instance, known] : x->programs) {
      const bool same = known.cell == cell
                        && known.task == request.labels.at("task")
                        && known.step == request.environment.at("ROSCELL_STEP");
      if (same && known.fence && x->index != me.index && known.runs(place.now())
          && place.has_lost(cell, x->name)
          && !was_ordered_before_loss(place, me, request.instance, x->name))
        place.report_violation("'" + request.instance + "' is started on "
                               + me.name + " while '" + instance
                               + "' may run on " + x->name);
    }
}

/// No instance is started twice, on two machines, or after it has finished.
void check_start(site& place, const site_party& me,
                 const start_container& request) {
  const auto home =
      place.homes.emplace(request.instance, me.index).first->second;
  if (home != me.index)
    place.report_violation("'" + request.instance + "' is started on " + me.name
                           + " and was on " + place.parties[home]->name);
  if (place.finished.count(request.instance) > 0)
    place.report_violation("'" + request.instance
                           + "' has finished and is started again");
  const auto known = me.programs.find(request.instance);
  if (known != me.programs.end() && known->second.runs(place.now()))
    place.report_violation("'" + request.instance
                           + "' is started while it runs");
}

caf::result<container_started> start(site* place, site_party* me,
                                     const start_container& request) {
  check_start(*place, *me, request);
  check_others(*place, *me, request);
  auto& program = me->programs[request.instance];
  program = {};
  program.instance = request.instance;
  program.container = "c" + std::to_string(++place->containers);
  program.cell = request.labels.at("cell");
  program.task = request.labels.at("task");
  program.step = request.environment.at("ROSCELL_STEP");
  program.script =
      program_script::from(request.environment.at("ROSCELL_PARAMETERS"));
  const auto& script = program.script;
  if (script.cannot_start) {
    me->programs.erase(request.instance);
    return fail(error_code::engine_failed, "the program cannot be started");
  }
  auto end_counts_from = place->now();
  if (script.ready_ms >= 0) {
    program.ready_at = place->now() + milliseconds{script.ready_ms};
    end_counts_from = *program.ready_at;
  }
  if (script.ends_ms >= 0)
    program.ends_at = end_counts_from + milliseconds{script.ends_ms};
  if (request.fence_boot_ms != 0)
    program.fence = moment_of(request.fence_boot_ms);
  watch(*place, *me, program);
  return container_started{program.container};
}

caf::result<container_stopped> stop(caf::event_based_actor* self, site* place,
                                    site_party* me,
                                    const stop_container& request) {
  auto* program = find(*me, request.instance);
  if (!program || !program->runs(place->now()))
    return container_stopped{program ? program->exit_code : -1};
  const auto takes =
      milliseconds{std::min(program->script.stop_ms, request.grace_ms)};
  const auto code = program->script.stop_ms > request.grace_ms
                        ? killed_code
                        : terminated_code;
  auto promise = self->make_response_promise<container_stopped>();
  place->later(*me, takes, [=, instance = request.instance]() mutable {
    auto* known = find(*me, instance);
    if (known && known->runs(place->now()))
      write_end(*place, *known, code);
    promise.deliver(container_stopped{known ? known->exit_code : code});
  });
  return promise;
}

container_adopted adopt(site* place, site_party* me,
                        const adopt_container& request) {
  const auto* program = find(*me, request.instance);
  if (!program)
    return {};
  return {program->runs(place->now()), program->container, program->exit_code};
}

caf::result<image_prepared> prepare(caf::event_based_actor* self, site* place,
                                    site_party* me,
                                    const prepare_image& request) {
  auto promise = self->make_response_promise<image_prepared>();
  place->later(*me, me->build_takes,
               [promise, me, image = request.skill]() mutable {
                 if (me->builds_fail)
                   promise.deliver(fail(error_code::engine_failed,
                                        "the image cannot be built"));
                 else
                   promise.deliver(image_prepared{image});
               });
  return promise;
}

host_measured measure(const site_party& me) {
  node_resources x;
  x.name = me.name;
  x.architecture = "amd64";
  x.cpu = {4, idle_cpu};
  x.memory_mib = {8192, 1024};
  x.disk_mib = {100'000, 10'000};
  return {x};
}

} // namespace

json program_script::parameters() const {
  return {{"ready_ms", ready_ms},
          {"ends_ms", ends_ms},
          {"exit_code", exit_code},
          {"stop_ms", stop_ms},
          {"cannot_start", cannot_start}};
}

program_script program_script::from(const std::string& parameters) {
  const auto known = json::parse(parameters);
  program_script x;
  x.ready_ms = known.value("ready_ms", x.ready_ms);
  x.ends_ms = known.value("ends_ms", x.ends_ms);
  x.exit_code = known.value("exit_code", x.exit_code);
  x.stop_ms = known.value("stop_ms", x.stop_ms);
  x.cannot_start = known.value("cannot_start", x.cannot_start);
  return x;
}

caf::message_handler program_edge(caf::event_based_actor* self, site* place,
                                  site_party* me) {
  return {
      [=](const prepare_image& x) { return prepare(self, place, me, x); },
      [=](const start_container& x) { return start(place, me, x); },
      [=](const stop_container& x) { return stop(self, place, me, x); },
      [=](const remove_container& x) {
        me->programs.erase(x.instance);
        return container_removed{};
      },
      [=](const adopt_container& x) { return adopt(place, me, x); },
      [=](const fence_container& x) {
        auto* program = find(*me, x.instance);
        if (program && program->container == x.container && program->fence)
          program->fence =
              std::max(*program->fence, moment_of(x.fence_boot_ms));
      },
      [](const ask_for_safety&) {},
      [=](const log_query& x) {
        return log_excerpt{x.instance, "", 0, true};
      },
      [=](const hear_container& x) {
        notify_listener(*me, {x.instance, false, false, false, "", true});
      },
      [=](const measure_host&) { return measure(*me); },
      [](const measure_use&) { return use_measured{}; },
      [](const mark_sample&) {},
  };
}

void resume_programs(site& place, site_party& x) {
  for (auto& [instance, program] : x.programs) {
    if (program.ended)
      continue;
    if (program.runs(place.now()))
      watch(place, x, program);
    else
      write_end(place, program, own_exit_code(program));
  }
}

void end_programs(site_party& x) {
  for (auto& [instance, program] : x.programs)
    program.ended = true;
}

} // namespace roscell::test
