#include "test/actors/session/recorded_peer.hpp"

#include <functional>
#include <set>

/// The member of a coordinator of this version whose session has a node of
/// commit 7566a8a at its other end, as it was recorded.
namespace {

using namespace roscell;
using namespace roscell::test;

/// What the recorded coordinator has asked, and the present one asks as well.
struct asked_again {
  json question;
  uint64_t id = 0;              ///< With which it is asked now.
  std::function<json()> answer; ///< What the present one has understood.
};

struct earlier_member : recorded_peer {
  wire_ptr link;
  member_actor it;
  std::map<uint64_t, asked_again> asked; ///< By the recorded id.
  std::map<uint64_t, std::string> said;  ///< Types of the node's requests.
  size_t notices = 0;

  void play(const recorded_session& recorded) {
    open(recorded);
    with_each_frame(recorded, [&](const auto& said_by, const auto& frame) {
      if (said_by.of_joiner)
        say(frame, said_by.text);
      else if (frame.kind == envelope_kind::request)
        ask(frame);
      else
        hear(frame);
    });
  }

private:
  void open(const recorded_session& recorded) {
    const auto hello = recorded.frame(0);
    node_identity who;
    who.name = hello.at("node");
    who.uuid = hello.at("uuid");
    who.epoch = hello.at("epoch");
    who.address = recorded.joiner;
    site.start_coordinator();
    link = make_wire(time.system, site.context, site.random, site.faults);
    caf::anon_send(site.base.actor, session_admitted{link->ends[0], who});
    caf::anon_send(link->ends[1],
                   own_session{caf::actor_cast<session_owner_actor>(peer)});
    site.pass(0s);
    it = site.base.members.at(0);
  }

  /// A word of the node.
  void say(const session_envelope& frame, std::string text) {
    if (frame.kind == envelope_kind::reply)
      return reply(frame);
    if (frame.kind == envelope_kind::request)
      said[frame.id] = frame.body.at("type");
    else
      ++notices;
    caf::anon_send(link->ends[1], send_frame{std::move(text)});
    site.pass(0s);
  }

  /// The node's answer has the id that is asked with now.
  void reply(const session_envelope& frame) {
    const auto question = asked.find(frame.id);
    if (question == asked.end())
      return;
    caf::anon_send(link->ends[1],
                   send_frame{write_envelope(envelope_kind::reply,
                                             question->second.id, frame.body)});
    site.pass(0s);
    CHECK(question->second.answer() == frame.body);
    answered.insert(frame.body.at("type"));
  }

  /// What the recorded coordinator has answered is answered in kind.
  void hear(const session_envelope& frame) {
    if (frame.kind != envelope_kind::reply
        || said[frame.id] == "node_departure")
      return;
    const auto ours = reply_to(frame.id);
    if (said[frame.id] == "node_registration")
      CHECK(ours["type"] == frame.body["type"]);
  }

  /// Has the member ask what the recorded coordinator has asked.
  void ask(const session_envelope& frame) {
    const auto type = frame.body.at("type").get<std::string>();
    asked_again x{frame.body, 0, {}};
    const auto known = questions.find(type);
    x.answer = known != questions.end() ? (this->*known->second)(frame.body)
                                        : pass_on(frame.body);
    site.pass(0s);
    REQUIRE(heard.back().kind == envelope_kind::request);
    CHECK(heard.back().body == frame.body);
    x.id = heard.back().id;
    asked[frame.id] = std::move(x);
  }

  using question = std::function<json()> (earlier_member::*)(const json&);

  /// What a coordinator asks an actor of its own; the rest is passed on as
  /// text.
  const std::map<std::string, question> questions{
      {resource_query::type,
       &earlier_member::put<resource_query, resource_report>},
      {figures_query::type,
       &earlier_member::put<figures_query, figures_report>},
      {instance_reservation::type,
       &earlier_member::put<instance_reservation, instances_reserved>},
      {instance_deployment::type,
       &earlier_member::put<instance_deployment, instance_deployed>},
      {instance_removal::type,
       &earlier_member::put<instance_removal, instances_removed>},
      {log_query::type, &earlier_member::put<log_query, log_excerpt>},
      {registration_switch::type,
       &earlier_member::put<registration_switch, switch_accepted>},
  };

  template <class Question, class Answer>
  std::function<json()> put(const json& body) {
    auto result =
        time.ask<Answer>(it, std::get<Question>(decode<Question>(body)));
    return [result] {
      REQUIRE(*result);
      return *result && (*result)->engaged()
                 ? message_json((*result)->value())
                 : error_reply(to_failure((*result)->error()));
    };
  }

  std::function<json()> pass_on(const json& body) {
    auto result = time.ask<request_routed>(it, route_request{body.dump(), ""});
    return [result] {
      REQUIRE(*result);
      return json::parse((*result)->value().text);
    };
  }
};

/// The sessions of the recorded member, each with a fixture of its own.
template <class F>
void with_each_session(F use) {
  for (const auto& recorded : read_recording().sessions) {
    if (recorded.is_of_peers())
      continue;
    earlier_member x;
    x.play(recorded);
    use(x);
  }
}

} // namespace

TEST_CASE("a coordinator understands all that a node of 7566a8a says") {
  std::set<std::string> said;
  std::set<std::string> answered;
  size_t notices = 0;
  with_each_session([&](earlier_member& x) {
    for (const auto& [id, type] : x.said)
      said.insert(type);
    answered.insert(x.answered.begin(), x.answered.end());
    notices += x.notices;
    CHECK(x.site.base.changes.size() == x.notices);
    CHECK(x.site.count("frame_refused") == 0);
  });
  CHECK(notices > 0);
  for (const auto* type : {"node_registration", "node_departure"})
    CHECK(said.count(type) == 1);
  for (const auto* type :
       {"resource_report", "instances_reserved", "instance_deployed",
        "instances_removed", "figures_report"})
    CHECK(answered.count(type) == 1);
}
