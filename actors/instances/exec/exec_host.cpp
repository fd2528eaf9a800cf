#include "actors/instances/exec/exec_host.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/exec/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/instances/exec/exec_steps.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

constexpr size_t session_id_bytes = 8;

caf::error crowded(exec_host_pointer self) {
  return fail(error_code::conflict,
              "node '" + self->state.config.node + "' runs "
                  + std::to_string(limits::exec::most)
                  + " commands beside its instances already",
              "", "end one of them: `roscell events` tells whose they are");
}

/// Empty: it can be run.
caf::error check_command(const exec_request& request) {
  size_t bytes = 0;
  for (const auto& x : request.command)
    bytes += x.size() + 1;
  if (request.command.empty() || request.command.front().empty())
    return fail(error_code::schema_violation, "there is no command to run",
                "/command", "name a program, as in `roscell exec I -- ls`");
  if (bytes > limits::exec::command_bytes)
    return fail(error_code::schema_violation,
                "the command has " + std::to_string(bytes)
                    + " bytes, and may have "
                    + std::to_string(limits::exec::command_bytes),
                "/command", "give it long texts on its standard input");
  return {};
}

/// Empty: a program of it runs, on which a command can be put beside.
caf::error check_instance(const instance_row& row) {
  const auto id = "instance '" + row.spec.instance + "'";
  const bool runs = row.state == instance_state::starting
                    || row.state == instance_state::running
                    || row.state == instance_state::stopping;
  if (!runs || row.container.empty())
    return fail(error_code::conflict,
                id + " does not run now: it is " + to_string(row.state),
                "/instance", "`roscell instances` shows which ones run");
  constexpr std::string_view actor = "actor:";
  if (row.container.compare(0, actor.size(), actor) == 0)
    return fail(error_code::conflict,
                id
                    + " is an actor of the program that has its node, and has "
                      "no environment of its own",
                "/instance", "run the command on that host");
  return {};
}

exec_order order_of(const exec_request& request, const instance_row& row,
                    const std::string& session) {
  exec_order result;
  result.instance = request.instance;
  result.container = row.container;
  result.session = session;
  result.command = request.command;
  result.terminal = request.terminal;
  result.size = {static_cast<int>(request.columns),
                 static_cast<int>(request.rows)};
  return result;
}

/// What the io thread tells of the command becomes messages.
exec_callbacks calls_for(exec_host_pointer self, const std::string& session) {
  const auto me = caf::actor_cast<exec_host_actor>(self);
  const auto report = [me, session](exec_progress x) {
    x.session = session;
    caf::anon_send(me, std::move(x));
  };
  exec_callbacks result;
  result.on_started = [report] { report({}); };
  result.on_output = [report](bool of_errors, std::string bytes) {
    exec_progress x;
    x.bytes = std::move(bytes);
    x.of_errors = of_errors;
    report(std::move(x));
  };
  result.on_input_taken = [report] {
    exec_progress x;
    x.input_taken = true;
    report(std::move(x));
  };
  result.on_end = [report](int exit_code, std::string reason) {
    exec_progress x;
    x.ended = true;
    x.exit_code = exit_code;
    x.reason = std::move(reason);
    report(std::move(x));
  };
  return result;
}

void open(exec_host_pointer self, const exec_request& request,
          const instance_row& row,
          caf::typed_response_promise<exec_started> promise) {
  auto& st = self->state;
  const auto id = to_hex(random_bytes(session_id_bytes));
  if (!st.table.begin(id, request.instance, request.terminal,
                      self->clock().now())) {
    promise.deliver(crowded(self));
    return;
  }
  auto opened = st.config.open(order_of(request, row, id), calls_for(self, id));
  if (const auto* why = std::get_if<edge_error>(&opened)) {
    st.table.remove(id);
    promise.deliver(to_caf(*why));
    return;
  }
  auto& x = st.attached[id];
  x.channel = std::get<std::shared_ptr<exec_channel>>(std::move(opened));
  x.starter = std::move(promise);
  st.config.context.publish_event(events::exec_begun, request.instance,
                                  {{"session", id},
                                   {"from", request.from},
                                   {"program", first_word(request.command)},
                                   {"terminal", request.terminal}});
  set_alarm(self);
}

caf::result<exec_started> begin(exec_host_pointer self,
                                const exec_request& request) {
  auto& st = self->state;
  if (auto why = check_command(request))
    return why;
  if (st.table.all().size() >= limits::exec::most)
    return crowded(self);
  auto promise = self->make_response_promise<exec_started>();
  instance_query query;
  query.instance = request.instance;
  self->request(st.config.supervisor, limits::local::part, query)
      .then(
          [=](const instance_description& known) mutable {
            const auto& row = known.instances.front();
            if (auto why = check_instance(row))
              promise.deliver(std::move(why));
            else
              open(self, request, row, promise);
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

json describe(const exec_host_state& st) {
  json sessions = json::object();
  for (const auto& [id, x] : st.table.all())
    sessions[id] = {{"instance", x.instance},
                    {"waiting_bytes", x.output.size()},
                    {"ended", x.ended}};
  return {{"commands", sessions}};
}

} // namespace

exec_host_actor::behavior_type exec_host(exec_host_pointer self,
                                         const exec_host_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) { return state_of(describe(self->state)); },
      [self](const exec_request& x) { return begin(self, x); },
      [self](const exec_input& x) { return take_input(self, x); },
      [self](const exec_output_query& x) { return give_output(self, x); },
      [self](const exec_progress& x) { on_progress(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell
