#include "test/actors/edge/session/session_fixture.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstring>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell::test::wire {

namespace {

std::string upgrade(const std::string& more = {},
                    const std::string& path = "/v1/session") {
  return "GET " + path
         + " HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket"
           "\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
           "Sec-WebSocket-Version: 13\r\n"
         + more + "\r\n";
}

/// For peers that never close their end.
session_options impatient() {
  session_options result;
  result.close_timeout = 50ms;
  return result;
}

/// One masked frame of WebSocket, whose mask is zero. `opcode` 1 is text.
std::string frame(const std::string& payload, int opcode = 1) {
  std::string result{static_cast<char>(0x80 | opcode)};
  const auto size = payload.size();
  if (size < 126) {
    result += static_cast<char>(0x80 | size);
  } else if (size < 65536) {
    result += static_cast<char>(0x80 | 126);
    result += static_cast<char>(size >> 8);
    result += static_cast<char>(size & 0xff);
  } else {
    result += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8)
      result += static_cast<char>((uint64_t{size} >> shift) & 0xff);
  }
  return result + std::string(4, '\0') + payload;
}

/// A raw client whose WebSocket is open.
raw_client open_websocket(const acceptor_fixture& node) {
  raw_client client{node.server->port()};
  client.send(upgrade());
  const auto reply = client.read_until("\r\n\r\n");
  REQUIRE(reply.find("HTTP/1.1 101 ") == 0);
  return client;
}

} // namespace

TEST_CASE("members of a whole cell may shake hands at one moment") {
  http_limits limits;
  limits.unauthenticated_peers = 2;
  limits.joining = 3;
  acceptor_fixture node{impatient(), site_token, limits};
  std::vector<raw_client> members;
  for (int i = 0; i < 3; ++i)
    members.push_back(open_websocket(node));
  raw_client unauthenticated_peer{node.server->port()};
  unauthenticated_peer.send("GET /healthz HTTP/1.1\r\n\r\n");
  unauthenticated_peer.read_until("hello");
  for (auto& x : members)
    CHECK_FALSE(x.is_closed());
  // One more makes room for itself among its like.
  members.push_back(open_websocket(node));
  CHECK_NOTHROW(members.front().read_to_end());
  for (std::size_t i = 1; i < members.size(); ++i)
    CHECK_FALSE(members[i].is_closed());
  CHECK_FALSE(unauthenticated_peer.is_closed());
}

TEST_CASE("with a wrong site token there is no session, and both hear why") {
  acceptor_fixture node;
  const auto why = expect_error(node.join({}, "wrong"));
  CHECK(why.code == error_code::unauthorized);
  CHECK(why.message.find("token") != std::string::npos);
  CHECK(node.refusals.take().code == error_code::unauthorized);
  CHECK(node.sessions.size() == 0);
  expect(node.join());
}

TEST_CASE("one side without a token and one with it do not match") {
  acceptor_fixture node;
  CHECK(expect_error(node.join({}, "")).code == error_code::unauthorized);
  acceptor_fixture bare{{}, ""};
  CHECK(expect_error(bare.join()).code == error_code::unauthorized);
}

TEST_CASE("no token on either side is no reason to trust, on loopback too") {
  acceptor_fixture bare{{}, ""};
  const auto why = expect_error(bare.join({}, ""));
  CHECK(why.code == error_code::unauthorized);
  CHECK(why.message.find("has no site token") != std::string::npos);
  CHECK(bare.refusals.take().code == error_code::unauthorized);
  CHECK(bare.sessions.size() == 0);
}

TEST_CASE(
    "who is asked for a proof gives it first, and no session comes of it") {
  acceptor_fixture node;
  const auto ask = [&](const std::string& token, const std::string& uuid) {
    inbox<std::optional<edge_error>> outcome;
    auto target = node.target();
    target.expected_uuid = uuid;
    ask_for_proof(node.io, target, robot_node, token, {},
                  [&](auto why) { outcome.put(std::move(why)); });
    return outcome.take();
  };
  CHECK_FALSE(ask(site_token, base_node.uuid));
  CHECK(node.refusals.take().message
        == "it asked for a proof of the site token only");
  CHECK(ask("another token", base_node.uuid)->code == error_code::unauthorized);
  CHECK(ask("", base_node.uuid)->code == error_code::unauthorized);
  CHECK(ask(site_token, "0000")->code == error_code::unknown_node);
  CHECK(node.sessions.size() == 0);
}

TEST_CASE("nobody there is unreachable, a silent server is a timeout") {
  io_thread io;
  inbox<session_result> outcome;
  const auto put = [&](session_result result) { outcome.put(result); };
  connect_session(io, {"127.0.0.1", 1, {}}, robot_node, site_token, {}, put);
  CHECK(expect_error(outcome.take()).code == error_code::unreachable);
  connect_session(io, {"robot.local", 1, {}}, robot_node, site_token, {}, put);
  CHECK(expect_error(outcome.take()).code == error_code::unreachable);

  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  ::bind(fd, generic, size);
  ::listen(fd, 1);
  ::getsockname(fd, generic, &size);
  session_options options;
  options.handshake_timeout = 50ms;
  connect_session(io, {"127.0.0.1", ntohs(address.sin_port), {}}, robot_node,
                  site_token, options, put);
  CHECK(expect_error(outcome.take()).code == error_code::timeout);
  ::close(fd);
}

TEST_CASE("a joiner that goes silent in the handshake is dropped in time") {
  session_options options;
  options.handshake_timeout = 50ms;
  acceptor_fixture node{options};
  auto client = open_websocket(node);
  client.send(frame(joiner_handshake{robot_node, site_token}.hello()));
  CHECK(client.read_to_end().find("session_challenge") != std::string::npos);
  CHECK(node.refusals.take().code == error_code::timeout);
}

TEST_CASE("a server that coordinates nothing takes no sessions") {
  http_fixture node;
  inbox<session_result> outcome;
  connect_session(node.io, {"127.0.0.1", node.server->port(), {}}, robot_node,
                  site_token, {},
                  [&](session_result result) { outcome.put(result); });
  const auto why = expect_error(outcome.take());
  CHECK(why.code == error_code::conflict);
  CHECK(why.message.find("coordinates no cell") != std::string::npos);
}

TEST_CASE("a joiner that wants another cell hears so") {
  acceptor_fixture node;
  auto target = node.target();
  target.expected_cell = "hall";
  inbox<session_result> outcome;
  connect_session(node.io, target, robot_node, site_token, {},
                  [&](session_result result) { outcome.put(result); });
  CHECK(expect_error(outcome.take()).code == error_code::unknown_cell);
  CHECK(node.refusals.take().code == error_code::unknown_cell);
}

TEST_CASE("another major version is refused on the wire") {
  acceptor_fixture node{impatient()};
  auto client = open_websocket(node);
  auto hello =
      nlohmann::json::parse(joiner_handshake{robot_node, site_token}.hello());
  hello["version"] = "3.0";
  client.send(frame(hello.dump()));
  CHECK(client.read_to_end().find("3.0 of node 'robot-1'")
        != std::string::npos);
  CHECK(node.refusals.take().code == error_code::conflict);
}

TEST_CASE("a recorded hello and proof open no session on the wire") {
  acceptor_fixture node{impatient()};
  joiner_handshake recorded{robot_node, site_token};
  auto victim = open_websocket(node);
  victim.send(frame(recorded.hello()));
  const auto challenge = victim.read_until("}");
  const auto proof = recorded.receive(challenge.substr(challenge.find('{')));
  victim.send(frame(proof.reply));
  CHECK(victim.read_until("}").find("session_accepted") != std::string::npos);
  node.sessions.take();

  auto thief = open_websocket(node);
  thief.send(frame(recorded.hello()));
  thief.read_until("}");
  thief.send(frame(proof.reply));
  CHECK(thief.read_to_end().find("unauthorized") != std::string::npos);
  CHECK(node.refusals.take().code == error_code::unauthorized);
}

TEST_CASE("garbage in place of frames is refused and does no harm") {
  acceptor_fixture node{impatient()};
  const std::string garbage[] = {frame("{}"),
                                 frame("not json"),
                                 frame(std::string(5000, 'x')),
                                 frame(std::string(100'000, '[')),
                                 frame("\xff\xff\xff"),
                                 frame("{}", 2),
                                 frame("", 8),
                                 frame("", 3),
                                 std::string(200, '\xff'),
                                 std::string(200, '\0')};
  for (const auto& bytes : garbage) {
    auto client = open_websocket(node);
    client.send(bytes);
    client.read_to_end();
    CHECK(node.refusals.take().message != "");
  }
  CHECK(node.sessions.size() == 0);
  expect(node.join());
}

namespace {

/// The session that a client of a robot has begun, frame by frame.
auto session_of(acceptor_fixture& node, raw_client& client) {
  joiner_handshake joiner{robot_node, site_token};
  client.send(frame(joiner.hello()));
  const auto challenge = client.read_until("}");
  client.send(
      frame(joiner.receive(challenge.substr(challenge.find('{'))).reply));
  client.read_until("}");
  return node.sessions.take();
}

} // namespace

TEST_CASE("a binary frame ends a session") {
  // Outlives the io thread, which tells it of the end.
  session_ear ear;
  acceptor_fixture node{impatient()};
  auto client = open_websocket(node);
  const auto session = session_of(node, client);
  session.link->start(ear.callbacks());
  client.send(frame("text"));
  CHECK(ear.frames.take() == "text");
  client.send(frame("binary", 2));
  CHECK(client.read_until("binary").find("binary frame") != std::string::npos);
  // It does not wait for ever for a peer that does not close.
  CHECK(ear.ends.take().why == session_end::cause::violation);
}

TEST_CASE("a peer that disappears is noticed at once") {
  // Outlives the io thread, which tells it of the end.
  session_ear ear;
  acceptor_fixture node;
  auto client = open_websocket(node);
  const auto session = session_of(node, client);
  session.link->start(ear.callbacks());
  client.close();
  CHECK(ear.ends.take().why == session_end::cause::lost);
}

TEST_CASE("what only looks like a request for a session gets an error") {
  acceptor_fixture node;
  const std::pair<std::string, std::string> requests[] = {
      {"GET /v1/session HTTP/1.1\r\nHost: x\r\n\r\n", " 400 "},
      {upgrade("Content-Length: 2\r\n") + "ab", " 400 "},
      {upgrade() + "early", " 400 "},
      {upgrade("Origin: http://evil.example\r\n"), " 403 "},
      {upgrade({}, "/v1/sessions"), " 401 "}};
  for (const auto& [text, status] : requests) {
    raw_client client{node.server->port()};
    client.send(text);
    const auto reply = client.read_to_end();
    INFO(text << reply);
    CHECK(reply.find("HTTP/1.1" + status) == 0);
    CHECK(reply.find("\"type\":\"error\"") != std::string::npos);
  }
}

TEST_CASE("sessions are counted, and places become free again") {
  // Outlives the io thread, which tells it of the end.
  session_ear ear;
  http_limits limits;
  limits.sessions = 1;
  acceptor_fixture node{{}, site_token, limits};
  auto first = expect(node.join());
  auto accepted = node.sessions.take();
  CHECK(expect_error(node.join()).code == error_code::conflict);
  accepted.link->start(ear.callbacks());
  first.link.reset();
  ear.ends.take();
  settle(node.io);
  expect(node.join());
}

TEST_CASE("sessions do not count as clients") {
  http_limits limits;
  limits.unauthenticated_peers = 1;
  acceptor_fixture node{{}, site_token, limits};
  std::vector<established_session> held;
  for (int i = 0; i < 5; ++i)
    held.push_back(expect(node.join()));
  raw_client client{node.server->port()};
  client.send(get("/", "Connection: close\r\n"));
  CHECK(client.read_to_end().find("hello") != std::string::npos);
}

TEST_CASE("a server that stops ends handshakes, not sessions") {
  // Outlives the io thread, which tells it of the end.
  session_ear ear;
  http_limits limits;
  limits.grace = 50ms;
  acceptor_fixture node{{}, site_token, limits};
  const auto joined = expect(node.join());
  const auto accepted = node.sessions.take();
  accepted.link->start(ear.callbacks());
  auto half = open_websocket(node);
  inbox<bool> stopped;
  node.server->stop([&] { stopped.put(true); });
  stopped.take();
  half.read_to_end();
  CHECK(joined.link->send("still here"));
  CHECK(ear.frames.take() == "still here");
}

} // namespace roscell::test::wire
