#include "actors/session/registration_client.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/session/proofs.hpp"
#include "actors/edge/session/session_handshake.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <caf/send.hpp>

#include <optional>
#include <utility>
#include <variant>

namespace roscell {

namespace {

failure no_node(const failure& why) {
  return {error_code::unreachable,
          "what answers there is no node of ROSCell: " + why.message};
}

} // namespace

std::variant<json, failure> read_answer(const std::string& text) {
  auto parsed = parse_document(text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return no_node(*why);
  auto& document = std::get<json>(parsed);
  if (const auto why = validate_message(document, {message_kind::reply}))
    return no_node(*why);
  if (document.at("type") == "error")
    return failure_from(document);
  return std::move(document);
}

namespace {

using registration_client_self =
    registration_client_actor::stateful_pointer<registration_client_state>;

/// On the io thread: turns an outcome into a message.
node_answered to_message(uint64_t call, const http_call& what,
                         http_outcome outcome) {
  auto result = to_edge_result(std::move(outcome), what);
  node_answered answer;
  answer.call = call;
  if (auto* why = std::get_if<edge_error>(&result))
    answer.problem = {why->code, why->message, "", why->hint, ""};
  else
    answer.body = std::move(std::get<http_reply>(result).body);
  return answer;
}

void send_to_node(registration_client_self self, uint64_t call,
                  const std::string& address, const std::string& uuid,
                  const std::string& method, const std::string& target,
                  const std::string& body) {
  auto& st = self->state;
  const auto to = *parse_socket_address(address);
  http_call what;
  what.to.address = to.address;
  what.to.port = to.port;
  what.to.identity = st.config.site.identity();
  what.to.uuid = uuid;
  what.method = method;
  what.target = target;
  what.body = body;
  call_http(
      st.config.io->core(), what,
      [me = registration_client_actor{self}, call, what](http_outcome outcome) {
        caf::anon_send(me, to_message(call, what, std::move(outcome)));
      });
}

/// The answer as `Reply`, or why it is none.
template <class Reply>
std::variant<Reply, failure> read(const node_answered& answer) {
  if (answer.body.empty())
    return answer.problem;
  return answer_as<Reply>(answer.body);
}

void end_registration_call(registration_client_self self, uint64_t call,
                           std::variant<switch_accepted, failure> outcome) {
  auto node = self->state.calls.extract(call);
  auto& promise = node.mapped().promise;
  if (auto* why = std::get_if<failure>(&outcome))
    promise.deliver(to_error(*why));
  else
    promise.deliver(std::get<switch_accepted>(outcome));
}

/// Whether the node that answers has the site token, too.
bool is_proven(const registration_challenge& x, const std::string& nonce,
               const std::string& site_token) {
  return proves(status_claim{nonce, x.node, x.uuid, x.epoch, x.state},
                site_token, x.proof);
}

failure unproven(const std::string& address, const std::string& node,
                 const std::string& uuid) {
  return {error_code::unauthorized,
          "what answers at " + address + " does not prove that it is node '"
              + node + "' with UUID " + uuid,
          "", "is it of the site of this node?", ""};
}

void on_challenge(registration_client_self self, uint64_t call,
                  const registration_challenge& challenge) {
  auto& st = self->state;
  auto& x = st.calls.at(call);
  auto& order = x.request.order;
  if (challenge.uuid != order.uuid || challenge.node != order.node)
    return end_registration_call(
        self, call,
        failure{error_code::unknown_node,
                "at " + x.request.address + " there is node '" + challenge.node
                    + "' with UUID " + challenge.uuid + ", not '" + order.node
                    + "'"});
  if (!is_proven(challenge, x.nonce, st.config.site.text()))
    return end_registration_call(
        self, call, unproven(x.request.address, order.node, order.uuid));
  // What the node announces may be a little older than what it says now.
  order.epoch = challenge.epoch;
  order.nonce = challenge.nonce;
  order.proof = prove(order_of(order), st.config.site.text());
  x.proven = true;
  send_to_node(self, call, x.request.address, order.uuid, "POST",
               registration_path, message_json(order).dump());
}

/// Why nobody at that address may be asked, if so.
std::optional<caf::error> address_refusal(const registration_client_state& st,
                                          const std::string& address) {
  const auto to = parse_socket_address(address);
  if (!to)
    return fail(error_code::unreachable,
                "'" + address + "' is not an address like 10.0.0.1:8420");
  if (!st.config.site.text().empty())
    return std::nullopt;
  const auto lack = st.config.site.what_lacks();
  return fail(error_code::unauthorized,
              "this node has no site token: " + lack.message, "", lack.hint);
}

/// Where a node tells its status, to one that proves to be of its site.
std::string question_target(const registration_client_state& st,
                            const std::string& nonce) {
  return std::string{registration_path} + "?nonce=" + nonce
         + "&proof=" + prove(status_question{nonce}, st.config.site.text());
}

caf::result<switch_accepted> call_node(registration_client_self self,
                                       const switch_node& request) {
  auto& st = self->state;
  if (auto why = address_refusal(st, request.address))
    return *why;
  auto promise = self->make_response_promise<switch_accepted>();
  const auto call = ++st.last_call;
  const auto nonce = make_nonce();
  st.calls.emplace(call, registration_call{request, nonce, false, promise});
  send_to_node(self, call, request.address, request.order.uuid, "GET",
               question_target(st, nonce), "");
  return promise;
}

// -- where a node stands ------------------------------------------------------

/// What a node's answer proves of its status, or why it does not.
std::variant<status_proved, failure>
judge_status(const node_answered& answer, const status_call& call,
             const std::string& site_token) {
  const auto challenge = read<registration_challenge>(answer);
  if (const auto* why = std::get_if<failure>(&challenge))
    return *why;
  const auto& x = std::get<registration_challenge>(challenge);
  if (x.uuid != call.request.uuid || x.node != call.request.node
      || !is_proven(x, call.nonce, site_token))
    return unproven(call.request.address, call.request.node, call.request.uuid);
  status_proved result;
  result.identity = {x.node, x.uuid, x.epoch, call.request.address};
  // The schema knows the words.
  result.state = json(x.state).get<node_state>();
  return result;
}

void on_status(registration_client_self self, const node_answered& answer) {
  auto node = self->state.questions.extract(answer.call);
  if (node.empty())
    return;
  auto& call = node.mapped();
  const auto verdict =
      judge_status(answer, call, self->state.config.site.text());
  if (const auto* why = std::get_if<failure>(&verdict))
    call.promise.deliver(to_error(*why));
  else
    call.promise.deliver(std::get<status_proved>(verdict));
}

caf::result<status_proved> ask_status(registration_client_self self,
                                      const prove_status& request) {
  auto& st = self->state;
  if (auto why = address_refusal(st, request.address))
    return *why;
  auto promise = self->make_response_promise<status_proved>();
  const auto call = ++st.last_call;
  const auto nonce = make_nonce();
  st.questions.emplace(call, status_call{request, nonce, promise});
  send_to_node(self, call, request.address, request.uuid, "GET",
               question_target(st, nonce), "");
  return promise;
}

void on_answer(registration_client_self self, const node_answered& answer) {
  auto i = self->state.calls.find(answer.call);
  if (i == self->state.calls.end())
    return on_status(self, answer);
  if (i->second.proven)
    return end_registration_call(self, answer.call,
                                 read<switch_accepted>(answer));
  auto challenge = read<registration_challenge>(answer);
  if (auto* why = std::get_if<failure>(&challenge))
    end_registration_call(self, answer.call, *why);
  else
    on_challenge(self, answer.call,
                 std::get<registration_challenge>(challenge));
}

} // namespace

registration_client_actor::behavior_type
registration_client(registration_client_self self,
                    const registration_client_config& config) {
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of({{"calls", self->state.last_call},
                         {"pending", self->state.calls.size()
                                         + self->state.questions.size()}});
      },
      [self](const switch_node& request) { return call_node(self, request); },
      [self](const prove_status& x) { return ask_status(self, x); },
      [self](const node_answered& x) { on_answer(self, x); },
  };
}

} // namespace roscell
