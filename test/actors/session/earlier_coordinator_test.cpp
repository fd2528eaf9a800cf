#include "test/actors/session/recorded_peer.hpp"

#include <set>

/// A membership of this version whose session has a coordinator of commit
/// 7566a8a at its other end, as it was recorded.
namespace {

using namespace roscell;
using namespace roscell::test;

struct earlier_coordinator : recorded_peer {
  caf::actor base;   ///< In the place of the site's.
  caf::actor router; ///< Of the node, for what only it can tell.
  session_actor session;
  std::map<uint64_t, json> said;  ///< What the recorded node has asked.
  std::map<uint64_t, json> asked; ///< What it was asked.
  json routed;                    ///< What the router answers.

  ~earlier_coordinator() {
    for (const auto& x : {base, router})
      time.kill(x);
  }

  void play(const recorded_session& recorded) {
    open(recorded);
    with_each_frame(recorded, [&](const auto& said_by, const auto& frame) {
      if (said_by.of_joiner)
        repeat(frame);
      else if (frame.kind == envelope_kind::request)
        ask(frame, answer_in(recorded, frame.id));
      else
        answer(frame);
    });
  }

private:
  void open(const recorded_session& recorded) {
    node.identity.name = recorded.frame(0).at("node");
    node.identity.uuid = recorded.frame(0).at("uuid");
    // To join raises it.
    node.identity.epoch = recorded.frame(0).at("epoch").get<int64_t>() - 1;
    spawn_parts();
    site.base.actor = caf::actor_cast<cell_coordinator_actor>(base);
    site.base.cell = recorded.frame(1).at("cell");
    site.base.incarnation = recorded.frame(1).at("incarnation");
    site.start(node);
    caf::anon_send(caf::actor_cast<membership_actor>(node.membership),
                   use_router{caf::actor_cast<request_router_actor>(router)});
    site.join(node);
    site.pass(1s);
  }

  void spawn_parts() {
    base = time.system.spawn([this](caf::event_based_actor*) -> caf::behavior {
      return {[this](const session_admitted& x) {
        session = x.session;
        caf::anon_send(session,
                       own_session{caf::actor_cast<session_owner_actor>(peer)});
      }};
    });
    router =
        time.system.spawn([this](caf::event_based_actor*) -> caf::behavior {
          return {[this](const route_request&) {
            return request_routed{routed.dump(), ""};
          }};
        });
  }

  static json answer_in(const recorded_session& recorded, uint64_t id) {
    for (auto i = handshake_frames; i < recorded.frames.size(); ++i) {
      const auto x = *read_envelope(recorded.frames[i].text);
      if (recorded.frames[i].of_joiner && x.kind == envelope_kind::reply
          && x.id == id)
        return x.body;
    }
    return nullptr;
  }

  /// The recorded node has asked this; the present one is brought to it.
  void repeat(const session_envelope& frame) {
    if (frame.kind != envelope_kind::request)
      return;
    said[frame.id] = frame.body;
    const auto type = frame.body.at("type").get<std::string>();
    if (type == node_departure::type)
      caf::anon_send(node.membership, leave_cell{frame.body.at("reason")});
    else if (type != node_registration::type)
      time.ask<request_routed>(node.membership,
                               route_request{frame.body.dump(), ""});
    site.pass(0s);
  }

  /// The coordinator's answer has the id with which the node asks now.
  void answer(const session_envelope& frame) {
    const auto question = said.find(frame.id);
    if (frame.kind != envelope_kind::reply || question == said.end())
      return;
    const auto& type = question->second.at("type");
    const auto same =
        std::find_if(heard.rbegin(), heard.rend(), [&](const auto& x) {
          return x.kind == envelope_kind::request && x.body["type"] == type;
        });
    REQUIRE(same != heard.rend());
    send(write_envelope(envelope_kind::reply, same->id, frame.body));
    answered.insert(type);
  }

  void ask(const session_envelope& frame, const json& recorded_answer) {
    routed = recorded_answer;
    send(write_envelope(envelope_kind::request, frame.id, frame.body));
    if (recorded_answer.is_null())
      return;
    const auto reply = reply_to(frame.id);
    INFO(reply.dump());
    CHECK(reply["type"] == recorded_answer["type"]);
    answered.insert(frame.body.at("type"));
  }

  void send(std::string text) {
    caf::anon_send(session, send_frame{std::move(text)});
    site.pass(1s);
  }
};

} // namespace

TEST_CASE("a node understands all that a coordinator of 7566a8a says") {
  std::set<std::string> answered;
  for (const auto& recorded : read_recording().sessions) {
    if (recorded.is_of_peers())
      continue;
    INFO(recorded.joiner << " to " << recorded.acceptor);
    earlier_coordinator x;
    x.play(recorded);
    answered.insert(x.answered.begin(), x.answered.end());
    CHECK(x.site.count("cell_joined") == 1);
  }
  for (const auto* type :
       {"node_registration", "node_departure", "resource_query",
        "instance_reservation", "instance_deployment", "instance_removal",
        "figures_query"})
    CHECK(answered.count(type) == 1);
}
