#include "actors/requests/request_router.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/requests/handler_pipeline.hpp"
#include "actors/requests/request_outline.hpp"
#include "actors/requests/secret_requests.hpp"
#include "messages/event_kinds.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/utf8.hpp"

#include <chrono>
#include <functional>
#include <utility>

namespace roscell {

namespace {

using request_router_self =
    request_router_actor::stateful_pointer<request_router_state>;
using promise_type = caf::typed_response_promise<request_routed>;

/// Longest text that says who has asked (schemas/exec_request.schema.json).
constexpr size_t most_sender_bytes = 256;

request_routed refusal(request_router_self self, const failure& why) {
  ++self->state.refused;
  return {error_reply(why).dump(-1, ' ', false, json::error_handler_t::replace),
          to_string(why.code)};
}

/// Answers a request, and whoever has sent it again meanwhile.
void answer_request(request_router_self self, const std::string& id,
                    promise_type promise, const request_routed& reply) {
  auto& st = self->state;
  promise.deliver(reply);
  if (id.empty())
    return;
  if (reply.refusal.empty())
    st.memory.finish(id, reply.text);
  else
    st.memory.forget(id);
  auto others = st.waiting.extract(id);
  if (!others.empty())
    for (auto& other : others.mapped())
      other.deliver(reply);
}

/// A refusal before anybody works on the request. A scraper does not want a
/// family of whatever word a client thinks of.
request_routed refuse_early(request_router_self self, const failure& why,
                            const std::string& type = "invalid") {
  self->state.services->context.count(metric::requests,
                                      {type, to_word(why.code)});
  return refusal(self, why);
}

void tally(request_router_self self, const running_request& request,
           const request_routed& answer) {
  const auto& home = self->state.services->context;
  const std::chrono::duration<double> span =
      self->clock().now() - request.since;
  home.count(metric::requests,
             {request.type, answer.refusal.empty() ? "done" : answer.refusal});
  home.observe(metric::request_seconds, {request.type}, span.count());
}

/// Whoever looks for it later finds who has asked for what.
void note_begin(request_router_self self, const route_request& request,
                const std::string& type, const json& document) {
  if (!is_remarkable(type) || !request.only.empty())
    return;
  json data{{"request", type}};
  if (!request.from.empty())
    data["from"] = request.from;
  if (const auto id = document.value("request_id", ""); !id.empty())
    data["request_id"] = id;
  self->state.services->context.publish_event(
      events::request_received, outline_of(document).subject, data);
}

void note_end(request_router_self self, const running_request& request,
              const request_routed& answer) {
  auto& history = *self->state.services->history;
  history.end(request.ticket, answer.refusal, self->clock().now());
  if (request.type == "task_request"
      && answer.refusal == to_string(error_code::no_feasible_allocation))
    history.decide({request.subject, unix_now_ms(), "", answer.text});
}

/// Answers the request of a pipeline, unless that has been done.
void settle(request_router_self self, const caf::actor_addr& worker,
            const std::function<request_routed()>& reply) {
  auto& running = self->state.running;
  auto i = running.find(worker);
  if (i == running.end())
    return;
  const auto request = std::move(i->second);
  running.erase(i);
  const auto answer = reply();
  tally(self, request, answer);
  note_end(self, request, answer);
  answer_request(self, request.id, request.promise, answer);
}

/// A pipeline that is killed cannot answer: it is answered for.
void on_pipeline_down(request_router_self self, const caf::down_msg& down) {
  settle(self, down.source, [&] {
    const bool has_words = down.reason.category() == caf::atom("roscell");
    return refusal(self,
                   to_failure(has_words ? down.reason
                                        : caf::make_error(
                                            caf::sec::request_receiver_down)));
  });
}

/// Gives each request a pipeline of its own.
void dispatch(request_router_self self, const request_runner& run,
              const std::string& id, json document, promise_type promise) {
  const auto& services = self->state.services;
  const auto type = document.at("type").get<std::string>();
  const auto subject = outline_of(document).subject;
  const auto now = self->clock().now();
  const auto ticket =
      is_remarkable(type)
          ? services->history->begin(type, subject, unix_now_ms(), now)
          : 0;
  auto worker =
      spawn(self->system(), services->context, handler_pipeline, run, services,
            std::make_shared<const json>(std::move(document)), ticket);
  const auto address = worker.address();
  self->state.running[address] = {id,  type,   subject,           ticket,
                                  now, worker, std::move(promise)};
  watch_until_its_end(self, worker);
  self->request(worker, limits::request::handler, process_request{})
      .then(
          [self, address](request_processed& done) {
            settle(self, address, [&] {
              return request_routed{std::move(done.text), ""};
            });
          },
          [self, address](const caf::error& why) {
            self->send_exit(address, caf::exit_reason::user_shutdown);
            settle(self, address,
                   [&] { return refusal(self, to_failure(why)); });
          });
}

/// Whether its first answer may have become wrong: a task that ran then may not
/// run now. The coordinator keeps itself that it does nothing twice.
bool is_checked_again(const std::string& type) {
  return type == task_request::type;
}

/// Handles a request with an id. False if it is to be worked on.
bool recall(request_router_self self, const std::string& type,
            const std::string& id, const std::string& body,
            promise_type& promise) {
  using status = answer_memory::status;
  auto& st = self->state;
  switch (st.memory.look(id, body)) {
  case status::unknown:
    st.memory.begin(id, body);
    return false;
  case status::begun:
    st.waiting[id].push_back(promise);
    return true;
  case status::answered:
    if (is_checked_again(type))
      return false;
    promise.deliver(request_routed{st.memory.answer(id), ""});
    return true;
  case status::taken:
    break;
  }
  promise.deliver(
      refuse_early(self,
                   {error_code::conflict,
                    "request_id '" + id + "' was used for another request",
                    "/request_id", "choose an id that has not been used"},
                   type));
  return true;
}

/// Whoever runs a command is told by the node that he has asked, and by nobody
/// whom he could make believe something: not by himself.
void note_sender(const route_request& request, const std::string& type,
                 json& document) {
  if (type != exec_request::type || !request.only.empty())
    return;
  constexpr std::string_view node = "node ";
  const bool by_node = request.from.compare(0, node.size(), node) == 0;
  const auto named = by_node ? document.value("from", "") : std::string{};
  document["from"] =
      valid_utf8(named.empty() ? request.from : named + " at " + request.from)
          .substr(0, most_sender_bytes);
}

/// What no handler of this node takes: on a member it is the coordinator's.
caf::result<request_routed> pass_on(request_router_self self,
                                    const std::string& type,
                                    const json& document) {
  const auto& membership = self->state.services->membership;
  if (!membership)
    return refuse_early(self, {error_code::unknown_type,
                               "this node has no handler for '" + type + "'",
                               "/type"});
  return self->delegate(membership, route_request{document.dump(), ""});
}

/// Whether somebody else answers it: a named node, or whoever knows them all.
bool is_for_others(const node_services& services, const std::string& type,
                   const json& document) {
  if (!relayed_limit(type))
    return false;
  const auto node = document.value("node", "");
  return (!node.empty() && node != services.name)
         || (!services.coordinator && document.value("cell", false));
}

/// By the coordinator, who has a session with each node.
caf::result<request_routed>
pass_to_node(request_router_self self, const std::string& type, json document) {
  const auto& coordinator = self->state.services->coordinator;
  if (!coordinator)
    return pass_on(self, type, document);
  const auto node = document.value("node", "");
  if (type == secret_setting::type && !self->state.services->has_identity)
    return refuse_early(self, secret_in_clear(node), type);
  // The node is to know that it is meant.
  document.erase("node");
  document.erase("request_id");
  auto promise = self->make_response_promise<request_routed>();
  self->request(coordinator, *relayed_limit(type) + 2 * relay_margin,
                relay_request{node, document.dump()})
      .then(
          [promise](request_routed& reply) mutable {
            promise.deliver(std::move(reply));
          },
          [self, promise](const caf::error& why) mutable {
            promise.deliver(refusal(self, to_failure(why)));
          });
  return promise;
}

caf::result<request_routed> route(request_router_self self,
                                  const route_request& request) {
  auto& st = self->state;
  ++st.routed;
  static_assert(document_limits{}.max_bytes == limits::http::body_bytes);
  auto parsed = parse_document(request.text);
  if (auto* why = std::get_if<failure>(&parsed))
    return refuse_early(self, *why);
  auto& document = std::get<json>(parsed);
  // What is taken from unauthenticated peers comes from coordinators, maybe
  // newer ones.
  if (auto why = request.only.empty()
                     ? validate_request(document)
                     : validate_message(document, {message_kind::request}))
    return refuse_early(self, without_value(document, *why));
  const auto type = document.at("type").get<std::string>();
  if (!request.only.empty() && type != request.only)
    return refuse_early(self,
                        {error_code::unauthorized,
                         "only a '" + request.only + "' is taken here", "/type",
                         "send it to /v1/requests"},
                        type);
  if (auto why = refuse_from_afar(type, request.from))
    return refuse_early(self, *why, type);
  note_begin(self, request, type, document);
  note_sender(request, type, document);
  if (is_for_others(*st.services, type, document))
    return pass_to_node(self, type, std::move(document));
  const auto* run = st.registry->find(type);
  if (!run)
    return pass_on(self, type, document);
  const auto id = may_be_remembered(type) ? document.value("request_id", "")
                                          : std::string{};
  auto promise = self->make_response_promise<request_routed>();
  if (!id.empty() && recall(self, type, id, document.dump(), promise))
    return promise;
  dispatch(self, *run, id, std::move(document), promise);
  return promise;
}

} // namespace

request_router_actor::behavior_type
request_router(request_router_self self,
               const std::shared_ptr<const request_registry>& registry,
               const std::shared_ptr<const node_services>& services) {
  self->state.registry = registry;
  self->state.services = services;
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_pipeline_down(self, down); });
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"routed", st.routed},
                         {"refused", st.refused},
                         {"remembered", st.memory.size()}});
      },
      [self](const route_request& request) { return route(self, request); },
  };
}

} // namespace roscell
