#include "actors/edge/http/http_server.hpp"
#include "actors/edge/session/heartbeat_socket.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell::test::wire {

namespace {

using heard = std::pair<heartbeat_kind, uint32_t>;

session_agreement agreement(const std::string& session, bool joiner) {
  const auto one = hmac_sha256("one", session);
  const auto two = hmac_sha256("two", session);
  return {session,
          joiner ? heartbeat_keys{one, two} : heartbeat_keys{two, one}};
}

/// One node's socket and what it hears of a session.
struct heartbeat_end {
  explicit heartbeat_end(io_thread& io, heartbeat_filter filter = {})
      : socket(expect(
          heartbeat_socket::open(io, {"127.0.0.1", 0, std::move(filter)}))) {
    // nop
  }

  /// A port of 0 leaves the peer's place open.
  void join(const std::string& session, bool joiner, uint16_t peer_port) {
    heartbeat_registration registration;
    registration.agreement = agreement(session, joiner);
    registration.address = "127.0.0.1";
    registration.port = peer_port;
    registration.on_heartbeat = [this](heartbeat_kind kind, uint32_t sequence) {
      heartbeats.put({kind, sequence});
    };
    link = socket->register_session(std::move(registration));
  }

  inbox<heard> heartbeats;
  std::unique_ptr<heartbeat_socket> socket;
  std::unique_ptr<heartbeat_link> link;
};

constexpr const char* session = "0123456789abcdef";

/// A member and its coordinator; the latter learns where the former is.
struct heartbeat_pair {
  explicit heartbeat_pair(heartbeat_filter of_coordinator = {})
      : coordinator(io, std::move(of_coordinator)) {
    member.join(session, true, coordinator.socket->port());
    coordinator.join(session, false, 0);
  }

  ~heartbeat_pair() {
    io.stop();
  }

  io_thread io;
  heartbeat_end member{io};
  heartbeat_end coordinator;
};

/// Sends packets as anybody could.
class unauthenticated_peer {
public:
  unauthenticated_peer()
      : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    // nop
  }

  unauthenticated_peer(const unauthenticated_peer&) = delete;
  unauthenticated_peer& operator=(const unauthenticated_peer&) = delete;

  ~unauthenticated_peer() {
    ::close(fd_);
  }

  void send(uint16_t port, std::string_view bytes) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::sendto(fd_, bytes.data(), bytes.size(), 0,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

private:
  int fd_;
};

std::string packet(uint32_t sequence,
                   heartbeat_kind kind = heartbeat_kind::heartbeat) {
  const auto bytes = encode_heartbeat({heartbeat_tag(session), kind, sequence},
                                      agreement(session, true).keys.send);
  return {bytes.data(), bytes.size()};
}

} // namespace

TEST_CASE("a heartbeat is heard, and its ack finds the way back") {
  heartbeat_pair pair;
  pair.member.link->send(heartbeat_kind::heartbeat, 0);
  CHECK(pair.coordinator.heartbeats.take()
        == heard{heartbeat_kind::heartbeat, 0});
  pair.coordinator.link->send(heartbeat_kind::ack, 0);
  CHECK(pair.member.heartbeats.take() == heard{heartbeat_kind::ack, 0});
  pair.coordinator.link->send(heartbeat_kind::probe, 0);
  CHECK(pair.member.heartbeats.take() == heard{heartbeat_kind::probe, 0});
  CHECK(pair.coordinator.socket->counters().accepted == 1);
  CHECK(pair.member.socket->counters().accepted == 2);
}

TEST_CASE("nothing is sent to a peer whose place is not known") {
  heartbeat_pair pair;
  pair.coordinator.link->send(heartbeat_kind::probe, 1);
  pair.member.link->send(heartbeat_kind::heartbeat, 1);
  pair.coordinator.heartbeats.take();
  pair.coordinator.link->send(heartbeat_kind::probe, 2);
  CHECK(pair.member.heartbeats.take() == heard{heartbeat_kind::probe, 2});
}

TEST_CASE("a sequence number that does not fit is not sent") {
  heartbeat_pair pair;
  pair.member.link->send(heartbeat_kind::heartbeat,
                         heartbeat_packet::max_sequence + 1);
  pair.member.link->send(heartbeat_kind::heartbeat,
                         heartbeat_packet::max_sequence);
  CHECK(pair.coordinator.heartbeats.take().second
        == heartbeat_packet::max_sequence);
  CHECK(pair.coordinator.heartbeats.size() == 0);
}

TEST_CASE("replayed and old packets are dropped and counted") {
  heartbeat_pair pair;
  const unauthenticated_peer thief;
  const auto port = pair.coordinator.socket->port();
  for (const uint32_t sequence : {5U, 5U, 4U, 0U, 6U, 5U})
    thief.send(port, packet(sequence));
  thief.send(port, packet(0, heartbeat_kind::probe));
  CHECK(pair.coordinator.heartbeats.take().second == 5);
  CHECK(pair.coordinator.heartbeats.take().second == 6);
  CHECK(pair.coordinator.heartbeats.take() == heard{heartbeat_kind::probe, 0});
  CHECK(pair.coordinator.socket->counters().replayed == 4);
}

TEST_CASE("forged, malformed and unknown packets are dropped and counted") {
  heartbeat_pair pair;
  const unauthenticated_peer forger;
  const auto port = pair.coordinator.socket->port();
  auto forged = packet(1);
  forged.back() ^= 1;
  forger.send(port, forged);
  // What the coordinator sent itself comes back.
  const auto own =
      encode_heartbeat({heartbeat_tag(session), heartbeat_kind::heartbeat, 9},
                       agreement(session, false).keys.send);
  forger.send(port, {own.data(), own.size()});
  auto unknown = packet(1);
  unknown.front() ^= 1;
  forger.send(port, unknown);
  forger.send(port, "");
  forger.send(port, packet(1).substr(1));
  forger.send(port, packet(1) + "x");
  forger.send(port, std::string(16, '\0'));
  forger.send(port, std::string(60'000, 'x'));
  forger.send(port, packet(2));
  CHECK(pair.coordinator.heartbeats.take().second == 2);
  const auto counters = pair.coordinator.socket->counters();
  CHECK(counters.accepted == 1);
  CHECK(counters.forged == 2);
  CHECK(counters.unknown == 1);
  CHECK(counters.malformed == 5);
}

TEST_CASE("a forged packet does not change where a peer is thought to be") {
  heartbeat_pair pair;
  pair.member.link->send(heartbeat_kind::heartbeat, 1);
  pair.coordinator.heartbeats.take();
  const unauthenticated_peer thief;
  thief.send(pair.coordinator.socket->port(), packet(1));
  auto forged = packet(2);
  forged.back() ^= 1;
  thief.send(pair.coordinator.socket->port(), forged);
  pair.member.link->send(heartbeat_kind::heartbeat, 2);
  pair.coordinator.heartbeats.take();
  pair.coordinator.link->send(heartbeat_kind::ack, 2);
  CHECK(pair.member.heartbeats.take() == heard{heartbeat_kind::ack, 2});
}

TEST_CASE("sessions that share a tag are told apart by their keys") {
  io_thread io;
  heartbeat_end node{io};
  heartbeat_end one{io};
  heartbeat_end two{io};
  const std::string first = "0123456700000000";
  const std::string second = "01234567ffffffff";
  one.join(first, true, node.socket->port());
  two.join(second, true, node.socket->port());
  node.join(first, false, 0);
  inbox<uint32_t> of_second;
  heartbeat_registration registration;
  registration.agreement = agreement(second, false);
  registration.on_heartbeat = [&](heartbeat_kind, uint32_t sequence) {
    of_second.put(sequence);
  };
  const auto other = node.socket->register_session(std::move(registration));
  one.link->send(heartbeat_kind::heartbeat, 1);
  two.link->send(heartbeat_kind::heartbeat, 2);
  CHECK(node.heartbeats.take().second == 1);
  CHECK(of_second.take() == 2);
  io.stop();
}

TEST_CASE("a session that was let go of is unknown") {
  heartbeat_pair pair;
  pair.coordinator.link.reset();
  settle(pair.io);
  pair.member.link->send(heartbeat_kind::heartbeat, 1);
  pair.coordinator.join("ffffffff00000000", false, 0);
  const unauthenticated_peer other;
  const auto bytes =
      encode_heartbeat({0xffffffff, heartbeat_kind::heartbeat, 1},
                       agreement("ffffffff00000000", true).keys.send);
  settle(pair.io);
  other.send(pair.coordinator.socket->port(), {bytes.data(), bytes.size()});
  CHECK(pair.coordinator.heartbeats.take().second == 1);
  CHECK(pair.coordinator.socket->counters().unknown == 1);
}

TEST_CASE("whoever watches a socket is told of each packet that is taken") {
  heartbeat_pair pair;
  inbox<int> seen;
  pair.coordinator.socket->watch([&] { seen.put(1); });
  pair.member.link->send(heartbeat_kind::heartbeat, 0);
  CHECK(seen.take() == 1);
  CHECK(pair.coordinator.heartbeats.take()
        == heard{heartbeat_kind::heartbeat, 0});
  pair.member.link->send(heartbeat_kind::heartbeat, 0); // Not newer.
  pair.member.link->send(heartbeat_kind::heartbeat, 1);
  CHECK(seen.take() == 1);
  CHECK(pair.coordinator.heartbeats.take()
        == heard{heartbeat_kind::heartbeat, 1});
  CHECK(seen.size() == 0);
}

TEST_CASE("a filter can lose, repeat and delay packets") {
  using action = traffic_verdict::action;
  heartbeat_pair pair{
      [](traffic_direction direction, const heartbeat_packet& packet) {
        traffic_verdict verdict;
        if (direction == traffic_direction::incoming)
          switch (packet.sequence) {
          case 1:
            return traffic_verdict{action::drop, 0ms, 1};
          case 2:
            return traffic_verdict{action::repeat, 0ms, 3};
          case 3:
            return traffic_verdict{action::delay, 20ms, 1};
          default:
            break;
          }
        return verdict;
      }};
  for (uint32_t i = 1; i <= 3; ++i)
    pair.member.link->send(heartbeat_kind::heartbeat, i);
  CHECK(pair.coordinator.heartbeats.take().second == 2);
  CHECK(pair.coordinator.heartbeats.take().second == 3);
  CHECK(pair.coordinator.socket->counters().replayed == 2);
  pair.member.link->send(heartbeat_kind::heartbeat, 4);
  CHECK(pair.coordinator.heartbeats.take().second == 4);
}

TEST_CASE("heartbeats after the end of their socket or thread do nothing") {
  heartbeat_pair pair;
  pair.coordinator.socket.reset();
  pair.coordinator.link->send(heartbeat_kind::heartbeat, 1);
  pair.member.link->send(heartbeat_kind::heartbeat, 1);
  settle(pair.io);
  pair.io.stop();
  pair.member.link->send(heartbeat_kind::heartbeat, 2);
  CHECK(pair.coordinator.heartbeats.size() == 0);
}

TEST_CASE("a UDP port in use is a conflict") {
  io_thread io;
  const auto first = expect(heartbeat_socket::open(io, {"127.0.0.1", 0, {}}));
  const auto why = expect_error(
      heartbeat_socket::open(io, {"127.0.0.1", first->port(), {}}));
  CHECK(why.code == error_code::conflict);
}

TEST_CASE("HTTP and heartbeats share a port number") {
  io_thread io;
  http_server_options options;
  options.port = 0;
  options.handler = [](const http_request&, const responder&) {};
  const auto sockets = expect(open_node_sockets(io, options));
  CHECK(sockets.http->port() != 0);
  CHECK(sockets.http->port() == sockets.heartbeat->port());
  options.port = sockets.http->port();
  const auto why = expect_error(open_node_sockets(io, options));
  CHECK(why.code == error_code::conflict);
}

} // namespace roscell::test::wire
