#include "actors/edge/session/proofs.hpp"
#include "actors/session/registration_client.hpp"
#include "messages/failure.hpp"
#include "test/site/site.hpp"

#include <caf/actor_cast.hpp>

#include <algorithm>
#include <utility>

namespace roscell::test {

namespace {

/// What a kernel takes to give up a host that does not answer.
constexpr auto silence_span = 5s;

// -- discovery ---------------------------------------------------------------

void announce(site* place, site_party* me, const node_presence& what) {
  me->announced = what;
  place->spread();
}

// -- sessions ----------------------------------------------------------------

/// Both sides have shaken hands.
session_opened admit(const wire_ptr& link, const site_party& to,
                     const open_session& request) {
  caf::anon_send(to.coordinator,
                 session_admitted{link->ends[0], request.self, request.role});
  return {link->ends[1], to.cell, to.name, to.cell_state().setup.incarnation};
}

void finish_connecting(site* place, site_party* me, const open_session& request,
                       caf::typed_response_promise<session_opened> promise) {
  auto* to = place->find_address(request.address);
  const auto refuse = [promise](const char* why) {
    auto answer = promise;
    answer.deliver(fail(error_code::unreachable, why));
  };
  if (!to || !place->reachable(me->index, to->index))
    return place->later(*me, silence_span, [refuse] { refuse("no answer"); });
  if (!request.uuid.empty() && request.uuid != to->uuid)
    return refuse("another node is there");
  auto link = to->coordinates ? place->connect(*me, *to) : nullptr;
  if (!link)
    return refuse("connection refused");
  promise.deliver(admit(link, *to, request));
}

caf::result<session_opened> open(caf::event_based_actor* self, site* place,
                                 site_party* me, const open_session& request) {
  auto promise = self->make_response_promise<session_opened>();
  auto* to = place->find_address(request.address);
  const auto fate =
      place->decide("connect", me->index, to ? to->index : me->index);
  auto delay = std::max(place->faults.longest_delay, 1ms);
  if (fate == frame_fate::late)
    delay += place->faults.late_by;
  if (fate == frame_fate::lost)
    place->later(*me, silence_span, [promise]() mutable {
      promise.deliver(fail(error_code::unreachable, "no answer"));
    });
  else
    place->later(*me, delay,
                 [=] { finish_connecting(place, me, request, promise); });
  return promise;
}

// -- REST --------------------------------------------------------------------

/// Shared by all that may end a call; the first one does.
template <class Reply>
using call_promise = std::shared_ptr<caf::typed_response_promise<Reply>>;

template <class Reply, class T>
void end_call(const call_promise<Reply>& promise, const T& outcome) {
  if (promise->pending())
    promise->deliver(outcome);
}

/// Carries one half of a REST call. Calls `lost` when it does not arrive.
void carry(site* place, site_party* from, site_party* to, const char* what,
           const std::function<void()>& arrive,
           const std::function<void()>& lost) {
  const auto fate = place->decide(what, from->index, to->index);
  std::uniform_real_distribution<double> chance;
  const bool gone =
      fate == frame_fate::lost || !place->reachable(from->index, to->index)
      || (place->drop_call > 0 && chance(place->random) < place->drop_call);
  if (gone)
    return lost();
  const auto delay = std::max(place->faults.longest_delay, 1ms);
  place->later(*to,
               fate == frame_fate::late ? delay + place->faults.late_by : delay,
               arrive);
  if (fate == frame_fate::repeated)
    place->later(*to, 2 * delay, arrive);
}

/// What a caller hears of a call that is not answered.
template <class Reply>
std::function<void()> give_up(site* place, site_party* me,
                              const call_promise<Reply>& promise) {
  return [=] {
    place->later(*me, silence_span, [promise] {
      end_call(promise, fail(error_code::timeout, "no answer"));
    });
  };
}

template <class Reply, class Request, class Outcome>
void ask_node(site* place, site_party* me, site_party* node,
              const Request& what, const call_promise<Outcome>& promise,
              const std::function<void(const Reply&)>& next) {
  if (!node->alive())
    return end_call(promise,
                    fail(error_code::unreachable, "connection refused"));
  const auto lost = give_up(place, me, promise);
  const auto answer = [=](const std::function<void()>& work) {
    carry(place, node, me, "reply", work, lost);
  };
  const auto arrive = [=] {
    place->time.system.spawn([=](caf::event_based_actor* self) {
      self->request(node->membership, 8s, what)
          .then([=](const Reply& x) { answer([=] { next(x); }); },
                [=](const caf::error& why) {
                  answer([=] { end_call(promise, why); });
                });
    });
  };
  carry(place, me, node, "call", arrive, lost);
  // Whatever becomes of it, the caller does not wait for ever.
  lost();
}

/// From somebody of the site.
registration_query question_with(char digit) {
  const std::string nonce(64, digit);
  return {nonce, prove(status_question{nonce}, site_token)};
}

caf::result<switch_accepted> switch_over(caf::event_based_actor* self,
                                         site* place, site_party* me,
                                         const switch_node& request) {
  auto* node = place->find_address(request.address);
  if (!node || node->coordinates)
    return fail(error_code::unreachable, "no node is there");
  auto reply = self->make_response_promise<switch_accepted>();
  auto promise = std::make_shared<decltype(reply)>(reply);
  const auto on_challenge = [=](const registration_challenge& challenge) {
    auto order = request.order;
    order.epoch = challenge.epoch;
    order.nonce = challenge.nonce;
    order.proof = prove(order_of(order), site_token);
    ask_node<switch_accepted>(
        place, me, node, order, promise,
        [=](const switch_accepted& x) { end_call(promise, x); });
  };
  ask_node<registration_challenge>(place, me, node, question_with('d'), promise,
                                   on_challenge);
  return reply;
}

/// The node proves where it stands, as the real REST API does.
caf::result<status_proved> ask_status(caf::event_based_actor* self, site* place,
                                      site_party* me,
                                      const prove_status& request) {
  auto* node = place->find_address(request.address);
  if (!node || node->coordinates)
    return fail(error_code::unreachable, "no node is there");
  auto reply = self->make_response_promise<status_proved>();
  auto promise = std::make_shared<decltype(reply)>(reply);
  const auto question = question_with('e');
  const auto on_challenge = [=](const registration_challenge& x) {
    const status_claim claim{question.nonce, x.node, x.uuid, x.epoch, x.state};
    if (x.uuid != request.uuid || !proves(claim, site_token, x.proof))
      return end_call(promise, fail(error_code::unauthorized, "no proof"));
    end_call(promise, status_proved{{x.node, x.uuid, x.epoch, request.address},
                                    json(x.state).get<node_state>()});
  };
  ask_node<registration_challenge>(place, me, node, question, promise,
                                   on_challenge);
  return reply;
}

// -- the disk ----------------------------------------------------------------

void write_record(site_party* me, const store_record& x) {
  auto& table = me->disk[x.table];
  if (x.value.empty())
    table.erase(x.key);
  else
    table[x.key] = x.value;
}

/// Writes what has waited for room.
void write_waiting(site* place, site_party* me) {
  if (me->disk_full && !me->waiting.empty())
    return place->later(*me, 1s, [=] { write_waiting(place, me); });
  for (const auto& x : std::exchange(me->waiting, {}))
    write_record(me, x);
}

/// A full disk keeps those that may wait in memory, and refuses others.
caf::result<record_stored> put_off(site* place, site_party* me,
                                   const store_records& x) {
  const bool may_wait =
      std::all_of(x.records.begin(), x.records.end(),
                  [](const auto& record) { return record.may_wait; });
  if (!may_wait)
    return fail(error_code::internal, "the disk is full");
  me->waiting.insert(me->waiting.end(), x.records.begin(), x.records.end());
  if (me->waiting.size() == x.records.size())
    place->later(*me, 1s, [=] { write_waiting(place, me); });
  return record_stored{};
}

caf::result<record_stored> write(caf::event_based_actor* self, site* place,
                                 site_party* me, const store_records& x) {
  const auto fate = place->decide("write", me->index, me->index);
  if (me->disk_full || fate == frame_fate::lost)
    return put_off(place, me, x);
  write_waiting(place, me);
  for (const auto& record : x.records)
    write_record(me, record);
  if (fate != frame_fate::late)
    return record_stored{};
  auto promise = self->make_response_promise<record_stored>();
  place->later(*me, place->faults.late_by,
               [promise]() mutable { promise.deliver(record_stored{}); });
  return promise;
}

} // namespace

caf::behavior site_edge(caf::event_based_actor* self, site* place,
                        site_party* me) {
  const caf::message_handler outside{
      [=](const announce_presence& x) { announce(place, me, x.self); },
      [=](const withdraw_presence&) { place->withdraw(*me); },
      [](const probe_server&) { return server_probed{}; },
      [=](const find_coordinator& x) {
        me->looking_for = x.address;
        place->look_up(*me);
        return caf::ok_atom_v;
      },
      [=](const forget_coordinator&) { me->looking_for.clear(); },
      [=](const serve_programs& x) {
        me->served = x;
        return programs_served{"10.0.0.9:11811"};
      },
      [](const stop_serving&) {
        // No program runs on this site.
      },
      [=](const follow_server& x) {
        me->followed.push_back(x);
        return caf::ok_atom_v;
      },
      [=](const open_session& x) { return open(self, place, me, x); },
      [=](const switch_node& x) { return switch_over(self, place, me, x); },
      [=](const prove_status& x) { return ask_status(self, place, me, x); },
      [=](const store_record& x) { return write(self, place, me, {{x}}); },
      [=](const store_records& x) { return write(self, place, me, x); },
      [=](caf::tick_atom, uint64_t number) { place->run_work(number); },
  };
  return program_edge(self, place, me).or_else(outside);
}

} // namespace roscell::test
