#include "actors/edge/limits.hpp"
#include "actors/edge/session/session_handshake.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace roscell {

namespace {

using nlohmann::json;

const joiner_identity robot{"robot-1", "0a1b-2c3d", 7};
const acceptor_identity base{"base", "ffff-0000", "kitchen", 3};
const std::string token = "site-token";

/// Both sides of one handshake, frame by frame.
struct pair_of_sides {
  acceptor_handshake acceptor{base, token};
  joiner_handshake joiner{robot, token};
  handshake_step challenge = acceptor.receive(joiner.hello());
};

/// A frame with one field changed.
std::string with(const std::string& frame, const char* key, const json& value) {
  auto result = json::parse(frame);
  result[key] = value;
  return result.dump();
}

std::string without(const std::string& frame, const char* key) {
  auto result = json::parse(frame);
  result.erase(key);
  return result.dump();
}

void check_refused(const handshake_step& step, error_code code) {
  REQUIRE(step.failure);
  INFO(step.failure->message);
  CHECK(step.failure->code == code);
  CHECK_FALSE(step.done);
}

} // namespace

TEST_CASE("nodes with the same token agree on a session and its keys") {
  pair_of_sides sides;
  CHECK_FALSE(sides.challenge.failure);
  const auto proof = sides.joiner.receive(sides.challenge.reply);
  CHECK_FALSE(proof.failure);
  CHECK_FALSE(proof.done);
  const auto accepted = sides.acceptor.receive(proof.reply);
  CHECK(accepted.done);
  const auto last = sides.joiner.receive(accepted.reply);
  CHECK(last.done);
  CHECK(last.reply.empty());

  const auto& ours = sides.joiner.agreement();
  const auto& theirs = sides.acceptor.agreement();
  CHECK(ours.session.size() == 16);
  CHECK(ours.session == theirs.session);
  CHECK(ours.keys.send == theirs.keys.receive);
  CHECK(ours.keys.receive == theirs.keys.send);
  CHECK(ours.keys.send != ours.keys.receive);
  CHECK(sides.acceptor.peer().node == "robot-1");
  CHECK(sides.acceptor.peer().epoch == 7);
  CHECK(sides.joiner.peer().cell == "kitchen");
  CHECK(sides.joiner.peer().incarnation == 3);
}

TEST_CASE("the token is in none of the frames") {
  pair_of_sides sides;
  const auto proof = sides.joiner.receive(sides.challenge.reply);
  const auto accepted = sides.acceptor.receive(proof.reply);
  const auto all = sides.joiner.hello() + sides.challenge.reply + proof.reply
                   + accepted.reply;
  CHECK(all.find(token) == std::string::npos);
  CHECK(all.find(to_hex(token)) == std::string::npos);
}

TEST_CASE("two handshakes of the same nodes have nothing in common") {
  pair_of_sides one;
  pair_of_sides two;
  CHECK(one.joiner.hello() != two.joiner.hello());
  CHECK(one.challenge.reply != two.challenge.reply);
}

TEST_CASE("a joiner refuses an acceptor without the token before it proves") {
  acceptor_handshake unauthenticated_peer{base, "other"};
  joiner_handshake joiner{robot, token};
  const auto step =
      joiner.receive(unauthenticated_peer.receive(joiner.hello()).reply);
  check_refused(step, error_code::unauthorized);
  CHECK(step.reply.find("session_proof") == std::string::npos);
  CHECK(step.failure->message.find("'base'") != std::string::npos);
  // The refusal arrives at the other side as what it is.
  check_refused(unauthenticated_peer.receive(step.reply),
                error_code::unauthorized);
}

TEST_CASE("an acceptor refuses a joiner without the token") {
  pair_of_sides sides;
  const auto step =
      sides.acceptor.receive(encode(session_proof{std::string(64, '0')}));
  check_refused(step, error_code::unauthorized);
  CHECK(step.failure->message.find("'robot-1'") != std::string::npos);
  CHECK(step.reply.find("unauthorized") != std::string::npos);
}

TEST_CASE("an acceptor's proof does not pass as a joiner's") {
  pair_of_sides sides;
  const auto proof = json::parse(sides.challenge.reply).at("proof");
  check_refused(sides.acceptor.receive(encode(session_proof{proof})),
                error_code::unauthorized);
}

TEST_CASE("a recorded hello and proof open no second session") {
  pair_of_sides sides;
  const auto proof = sides.joiner.receive(sides.challenge.reply);
  REQUIRE(sides.acceptor.receive(proof.reply).done);
  acceptor_handshake later{base, token};
  REQUIRE_FALSE(later.receive(sides.joiner.hello()).failure);
  check_refused(later.receive(proof.reply), error_code::unauthorized);
}

TEST_CASE("a recorded challenge convinces no joiner") {
  pair_of_sides sides;
  joiner_handshake later{robot, token};
  check_refused(later.receive(sides.challenge.reply), error_code::unauthorized);
}

TEST_CASE("a proof given to one acceptor is worth nothing to another one") {
  acceptor_handshake other{{"base-2", "eeee-0000", "hall", 3}, token};
  pair_of_sides sides;
  REQUIRE_FALSE(other.receive(sides.joiner.hello()).failure);
  const auto proof = sides.joiner.receive(sides.challenge.reply);
  check_refused(other.receive(proof.reply), error_code::unauthorized);
}

TEST_CASE("every field of hello and challenge is under the proofs") {
  const std::pair<const char*, json> of_hello[] = {
      {"version", "2.1"},
      {"node", "robot-2"},
      {"uuid", "aaaa"},
      {"epoch", 8},
      {"nonce", std::string(64, '1')},
      {"role", "coordinator"}};
  for (const auto& [key, value] : of_hello) {
    acceptor_handshake acceptor{base, token};
    joiner_handshake joiner{robot, token};
    const auto challenge = acceptor.receive(with(joiner.hello(), key, value));
    INFO(key);
    REQUIRE_FALSE(challenge.failure);
    check_refused(joiner.receive(challenge.reply), error_code::unauthorized);
  }
  const std::pair<const char*, json> of_challenge[] = {
      {"version", "2.1"},
      {"node", "other"},
      {"uuid", "aaaa"},
      {"cell", "hall"},
      {"incarnation", 4},
      {"nonce", std::string(64, '1')},
      {"proof", std::string(64, '1')}};
  for (const auto& [key, value] : of_challenge) {
    pair_of_sides sides;
    INFO(key);
    check_refused(sides.joiner.receive(with(sides.challenge.reply, key, value)),
                  error_code::unauthorized);
  }
}

TEST_CASE("a coordinator's role is agreed on, and cannot be taken away") {
  const joiner_identity peer{"hall-1", "0a1b-2c3d", 9, "coordinator"};
  acceptor_handshake acceptor{base, token};
  joiner_handshake joiner{peer, token};
  const auto challenge = acceptor.receive(joiner.hello());
  const auto proof = joiner.receive(challenge.reply);
  const auto accepted = acceptor.receive(proof.reply);
  REQUIRE(accepted.done);
  CHECK(joiner.receive(accepted.reply).done);
  CHECK(acceptor.peer().role == coordinator_role);
  CHECK(joiner.agreement().keys.send == acceptor.agreement().keys.receive);

  acceptor_handshake deceived{base, token};
  joiner_handshake again{peer, token};
  const auto stripped = deceived.receive(without(again.hello(), "role"));
  REQUIRE_FALSE(stripped.failure);
  check_refused(again.receive(stripped.reply), error_code::unauthorized);
}

TEST_CASE("a joiner without a role proves what it did before there were any") {
  const std::string nonce(64, '0');
  acceptor_handshake acceptor{base, token, nonce};
  joiner_handshake joiner{robot, token, {}, nonce};
  CHECK_FALSE(json::parse(joiner.hello()).contains("role"));
  const auto challenge = json::parse(acceptor.receive(joiner.hello()).reply);
  CHECK(challenge.at("proof")
        == "7524afa429d0075dd3ccd7e1004fefe69584239efe3470adb6f39a11e0968420");
}

TEST_CASE("the acceptance of a session is proven, too") {
  pair_of_sides sides;
  sides.joiner.receive(sides.challenge.reply);
  check_refused(
      sides.joiner.receive(encode(session_accepted{"0123456789abcdef"})),
      error_code::unauthorized);
}

TEST_CASE("another major version is refused by name, another minor is not") {
  acceptor_handshake acceptor{base, token};
  joiner_handshake joiner{robot, token};
  const auto step = acceptor.receive(with(joiner.hello(), "version", "3.0"));
  check_refused(step, error_code::conflict);
  CHECK(step.failure->message.find("3.0 of node 'robot-1'")
        != std::string::npos);
  CHECK(step.reply.find("3.0 of node") != std::string::npos);

  pair_of_sides sides;
  check_refused(
      sides.joiner.receive(with(sides.challenge.reply, "version", "0.9")),
      error_code::conflict);

  acceptor_handshake newer{base, token};
  CHECK_FALSE(newer.receive(with(joiner.hello(), "version", "2.12")).failure);
}

TEST_CASE("a joiner that wants a certain cell takes no other") {
  for (const auto* cell : {"kitchen", "hall"}) {
    acceptor_handshake acceptor{base, token};
    joiner_handshake joiner{robot, token, cell};
    const auto step = joiner.receive(acceptor.receive(joiner.hello()).reply);
    if (cell == base.cell)
      CHECK_FALSE(step.failure);
    else
      check_refused(step, error_code::unknown_cell);
  }
}

TEST_CASE("a joiner that wants a certain node proves nothing to another one") {
  for (const auto& uuid : {base.uuid, std::string{"another"}}) {
    acceptor_handshake acceptor{base, token};
    joiner_handshake joiner{robot, token};
    joiner.expect_uuid(uuid);
    const auto step = joiner.receive(acceptor.receive(joiner.hello()).reply);
    if (uuid == base.uuid) {
      CHECK_FALSE(step.failure);
      continue;
    }
    check_refused(step, error_code::unknown_node);
    CHECK_FALSE(acceptor.receive(step.reply).done);
  }
}

TEST_CASE("an empty token proves nothing, on neither side") {
  acceptor_handshake bare{base, ""};
  joiner_handshake joiner{robot, ""};
  check_refused(bare.receive(joiner.hello()), error_code::unauthorized);

  // Whoever makes a proof under the empty token gets no further.
  const auto forged = [](const std::string& proof) {
    return json{{"type", "session_proof"}, {"proof", proof}}.dump();
  };
  acceptor_handshake acceptor{base, token};
  const auto challenge = json::parse(acceptor.receive(joiner.hello()).reply);
  for (const auto& proof : {std::string{}, std::string(64, '0'),
                            challenge.at("proof").get<std::string>()}) {
    acceptor_handshake again{base, token};
    again.receive(joiner.hello());
    const auto step = again.receive(forged(proof));
    REQUIRE(step.failure);
    CHECK_FALSE(step.done);
  }
}

TEST_CASE("both sides read the same of tokens that differ, and of one that is "
          "missing") {
  const std::pair<std::string, std::string> rows[] = {
      {"other",
       "the site token of node 'robot-1' is not that of node 'base' of cell "
       "'kitchen'"},
      {"", "node 'robot-1' has no site token, and cell 'kitchen' wants one"}};
  for (const auto& [own, words] : rows) {
    acceptor_handshake acceptor{base, token};
    joiner_handshake joiner{robot, own};
    const auto step = joiner.receive(acceptor.receive(joiner.hello()).reply);
    check_refused(step, error_code::unauthorized);
    CHECK(step.failure->message == words);
    CHECK(step.failure->hint.find("copy the site token") == 0);
    CHECK(acceptor.receive(step.reply).failure->message == words);
  }
}

TEST_CASE("who lacks the token is named to the other side") {
  acceptor_handshake remote{base, ""};
  joiner_handshake joiner{robot, token};
  const auto step = remote.receive(joiner.hello());
  check_refused(joiner.receive(step.reply), error_code::unauthorized);
  CHECK(step.failure->message.find("node 'base' of cell 'kitchen' has no site "
                                   "token")
        == 0);
}

TEST_CASE("fields of a frame are checked before they are used") {
  const auto hello = joiner_handshake{robot, token}.hello();
  const std::pair<const char*, json> broken[] = {
      {"version", "1"},
      {"version", "1."},
      {"version", ".1"},
      {"version", "1.0.0"},
      {"version", "one.two"},
      {"version", "1.00000000000000000"},
      {"version", 1.0},
      {"node", ""},
      {"node", std::string(limits::text::name_bytes + 1, 'x')},
      {"node", "a\nb"},
      {"node", nullptr},
      {"uuid", ""},
      {"uuid", "xyz"},
      {"uuid", std::string(limits::text::uuid_bytes + 1, 'a')},
      {"epoch", -1},
      {"epoch", 1.5},
      {"epoch", "7"},
      {"epoch", uint64_t{1} << 53},
      {"nonce", std::string(63, '0')},
      {"nonce", std::string(66, '0')},
      {"nonce", std::string(64, 'g')},
      {"nonce", json::array()},
      {"role", "king"},
      {"role", 1},
      {"role", nullptr}};
  for (const auto& [key, value] : broken) {
    acceptor_handshake acceptor{base, token};
    const auto step = acceptor.receive(with(hello, key, value));
    INFO(key << " " << value);
    check_refused(step, error_code::schema_violation);
  }
  for (const auto* key :
       {"version", "node", "uuid", "epoch", "nonce", "type"}) {
    acceptor_handshake acceptor{base, token};
    const auto step = acceptor.receive(without(hello, key));
    check_refused(step, error_code::schema_violation);
    CHECK(step.failure->message.find(key) != std::string::npos);
  }
}

TEST_CASE("what is no frame at all is refused") {
  for (const std::string text : {"", "null", "[]", "{", "\"session_hello\"",
                                 "{\"type\":1}", "\xff\xfe", "{} {}"}) {
    acceptor_handshake acceptor{base, token};
    INFO(text);
    CHECK(acceptor.receive(text).failure);
  }
  acceptor_handshake acceptor{base, token};
  check_refused(acceptor.receive(std::string(5000, '[')),
                error_code::malformed_json);
}

TEST_CASE("frames out of turn end the handshake") {
  pair_of_sides sides;
  check_refused(sides.acceptor.receive(sides.joiner.hello()),
                error_code::schema_violation);
  check_refused(sides.acceptor.receive(sides.joiner.hello()),
                error_code::conflict);
  joiner_handshake joiner{robot, token};
  check_refused(joiner.receive(encode(session_accepted{std::string(16, '0')})),
                error_code::schema_violation);
}

TEST_CASE("an unknown field of a frame is ignored") {
  acceptor_handshake acceptor{base, token};
  joiner_handshake joiner{robot, token};
  const auto challenge = acceptor.receive(with(joiner.hello(), "new", {1, 2}));
  CHECK_FALSE(joiner.receive(challenge.reply).failure);
}

TEST_CASE("the error of a peer is tamed before it is shown") {
  joiner_handshake joiner{robot, token};
  const auto text = "a\nb" + std::string(2000, 'x');
  const json frame{{"type", "error"},
                   {"error", {{"code", "conflict"}, {"message", text}}}};
  const auto step = joiner.receive(frame.dump());
  check_refused(step, error_code::conflict);
  CHECK(step.failure->message.substr(0, 3) == "a b");
  CHECK(step.failure->message.size() == 1000);
  CHECK(joiner_handshake{robot, token}.receive(R"({"type":"error"})").failure);
}

} // namespace roscell
