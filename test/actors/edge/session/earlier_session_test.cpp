#include "actors/edge/session/heartbeat_packet.hpp"
#include "actors/edge/session/session_handshake.hpp"
#include "test/recording.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <set>

/// Sessions with nodes of commit 7566a8a, as these were recorded.
namespace roscell {

namespace {

using nlohmann::json;

template <class Frame>
Frame frame_of(const test::recorded_session& x, size_t i) {
  return std::get<Frame>(decode_frame<Frame>(x.frames.at(i).text));
}

/// This version in the place of who has accepted the session.
acceptor_handshake acceptor_in(const test::recorded_session& x,
                               const std::string& token) {
  const auto said = frame_of<session_challenge>(x, 1);
  return acceptor_handshake{
      {said.node, said.uuid, said.cell, said.incarnation}, token, said.nonce};
}

/// What both ends have agreed upon, as the acceptor has it.
session_agreement agreement_of(const test::recorded_session& x,
                               const std::string& token) {
  auto it = acceptor_in(x, token);
  REQUIRE_FALSE(it.receive(x.frames.at(0).text).failure);
  REQUIRE(it.receive(x.frames.at(2).text).done);
  return it.agreement();
}

} // namespace

TEST_CASE("a joiner of 7566a8a gets the answers that it got from its own "
          "version") {
  const auto recorded = test::read_recording();
  for (const auto& x : recorded.sessions) {
    auto it = acceptor_in(x, recorded.site_token);
    CHECK(json::parse(it.receive(x.frames.at(0).text).reply) == x.frame(1));
    const auto last = it.receive(x.frames.at(2).text);
    CHECK(last.done);
    CHECK(json::parse(last.reply) == x.frame(3));
  }
}

TEST_CASE("a joiner says to an acceptor of 7566a8a what one of that version "
          "said") {
  const auto recorded = test::read_recording();
  for (const auto& x : recorded.sessions) {
    const auto said = frame_of<session_hello>(x, 0);
    joiner_identity self{said.node, said.uuid, said.epoch};
    self.role = said.role;
    joiner_handshake it{self, recorded.site_token, "", said.nonce};
    CHECK(json::parse(it.hello()) == x.frame(0));
    CHECK(json::parse(it.receive(x.frames.at(1).text).reply) == x.frame(2));
    CHECK(it.receive(x.frames.at(3).text).done);
  }
}

TEST_CASE("heartbeats of 7566a8a are taken as those of their session") {
  const auto recorded = test::read_recording();
  std::map<uint32_t, std::pair<test::recorded_session, session_agreement>> all;
  for (const auto& x : recorded.sessions) {
    const auto agreed = agreement_of(x, recorded.site_token);
    all[heartbeat_tag(agreed.session)] = {x, agreed};
  }
  std::set<heartbeat_kind> kinds;
  for (const auto& heartbeat : recorded.heartbeats) {
    const auto packet = read_heartbeat(heartbeat.bytes);
    REQUIRE(packet);
    REQUIRE(all.count(packet->tag) == 1);
    const auto& [session, agreed] = all[packet->tag];
    const bool of_joiner = session.joiner.rfind(heartbeat.from + ":", 0) == 0;
    CHECK(is_authentic_heartbeat(
        heartbeat.bytes, of_joiner ? agreed.keys.receive : agreed.keys.send));
    const auto ours = encode_heartbeat(*packet, of_joiner ? agreed.keys.receive
                                                          : agreed.keys.send);
    CHECK(std::string(ours.begin(), ours.end()) == heartbeat.bytes);
    kinds.insert(packet->kind);
  }
  CHECK(kinds.count(heartbeat_kind::heartbeat) == 1);
  CHECK(kinds.count(heartbeat_kind::ack) == 1);
}

} // namespace roscell
