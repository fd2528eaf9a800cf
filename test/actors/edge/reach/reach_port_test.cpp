#include "actors/edge/http/http_server.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/reach/reach_port.hpp"
#include "actors/edge/reach/reach_tries.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

using namespace roscell;

namespace {

std::string_view text_of(const std::vector<std::uint8_t>& x) {
  return {reinterpret_cast<const char*>(x.data()), x.size()};
}

std::string_view text_of(const reach_bytes& x) {
  return {x.data(), x.size()};
}

constexpr auto token = "a site token";
const auto key = reach_key(token);

} // namespace

TEST_CASE("who knows the site token is answered, once and shortly", "[reach]") {
  const auto nonce = make_reach_nonce();
  for (const size_t size : {size_t{0}, reach_packet_size, size_t{16384}}) {
    const auto question = reach_question(nonce, key, size);
    CHECK(question.size() == std::max(size, reach_packet_size));
    const auto answer = reach_answer(text_of(question), token);
    REQUIRE(answer);
    CHECK(is_reach_answer(text_of(*answer), nonce, key));
    // An answer is no question: two nodes never answer each other for ever.
    CHECK_FALSE(reach_answer(text_of(*answer), token));
  }
}

TEST_CASE("who does not know the site token is not answered", "[reach]") {
  const auto question =
      reach_question(make_reach_nonce(), reach_key("another"), 64);
  CHECK_FALSE(reach_answer(text_of(question), token));
  CHECK_FALSE(reach_answer("", token));
  CHECK_FALSE(reach_answer("ROSCELL?", token));
}

TEST_CASE("a node without a site token answers nobody", "[reach]") {
  const auto question = reach_question(make_reach_nonce(), reach_key(""), 64);
  CHECK_FALSE(reach_answer(text_of(question), ""));
}

TEST_CASE("an answer that was changed, or is to another question, is none",
          "[reach]") {
  const auto nonce = make_reach_nonce();
  const auto answer =
      reach_answer(text_of(reach_question(nonce, key, 0)), token);
  REQUIRE(answer);
  CHECK_FALSE(is_reach_answer(text_of(*answer), make_reach_nonce(), key));
  for (size_t i = 0; i < answer->size(); ++i) {
    auto changed = *answer;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    CHECK_FALSE(is_reach_answer(text_of(changed), nonce, key));
  }
}

using namespace roscell::test::wire;

namespace {

constexpr auto loopback = "127.0.0.1";

constexpr auto hello = R"({"type":"node_hello","node":"arm",
  "role":"primary","state":"independent","version":"0.1.0","domain_id":0,
  "public_domain":99})";

/// A node's sockets, under a site token of its own.
struct reachable_node {
  node_sockets sockets;
  std::unique_ptr<reach_port> port;

  reachable_node(io_thread& io, const std::string& token) {
    http_server_options options;
    options.address = loopback;
    options.port = 0;
    options.public_paths = {hello_path};
    options.handler = [](const http_request&, const responder& answer) {
      answer.reply(200, json_content, hello);
    };
    heartbeat_socket_options heartbeats;
    heartbeats.site = token;
    sockets = expect(open_node_sockets(io, options, heartbeats));
    port = expect(reach_port::open(io, {loopback, 71, token}));
  }

  reach_goal goal(const std::string& name) const {
    return {name,
            std::string{loopback} + ":" + std::to_string(sockets.http->port()),
            "", port->port()};
  }
};

/// By the words of the enums, which a failed check shows.
using answers = std::map<std::string_view, std::string_view>;

answers try_goal(io_thread& io, const reach_goal& goal) {
  inbox<std::vector<reach_row>> reported;
  try_to_reach(
      {io.core(), loopback, reach_key("token")}, {goal},
      [&](std::vector<reach_row> rows) { reported.put(std::move(rows)); });
  answers result;
  for (const auto& row : reported.take()) {
    CHECK(row.node == goal.node);
    CHECK((row.round_trip_ms >= 0) == (row.answer == port_answer::found));
    result[enum_words(row.way)[static_cast<size_t>(row.way)]] =
        enum_words(row.answer)[static_cast<size_t>(row.answer)];
  }
  return result;
}

} // namespace

TEST_CASE("a node is reached by its port, its heartbeats and its data",
          "[reach]") {
  io_thread io{[](const std::string&) {}};
  {
    const reachable_node arm{io, "token"};
    // Multicast on the loopback interface is the kernel's own matter.
    const auto found = try_goal(io, arm.goal("arm"));
    for (const auto* way : {"session", "beat", "data", "large"}) {
      INFO(way);
      CHECK(found.at(way) == "found");
    }
    CHECK(found.count("discovery") == 0);
    CHECK(arm.sockets.heartbeat->counters().malformed == 0);
  }
  io.stop();
}

TEST_CASE("a node answers from the address by which it is known", "[reach]") {
  io_thread io{[](const std::string&) {}};
  {
    // The kernel itself would answer from 127.0.0.1.
    constexpr auto second = "127.0.0.2";
    const auto port = expect(reach_port::open(io, {second, 72, "token"}));
    const auto found =
        try_goal(io, {"arm", std::string{second} + ":1", "", port->port()});
    CHECK(found.at("data") == "found");
    CHECK(found.at("large") == "found");
  }
  io.stop();
}

TEST_CASE("a host without skills has one port for data", "[reach]") {
  io_thread io{[](const std::string&) {}};
  {
    const auto port = expect(reach_port::open(io, {loopback, 73, "token"}));
    CHECK(port->port() == 7400 + 250 * 73 + 91);
    CHECK(first_data_port_beside(port->port()) == port->port());
  }
  io.stop();
}

TEST_CASE("what is reached is where the first skills and the next one listen",
          "[reach]") {
  io_thread io{[](const std::string&) {}};
  {
    constexpr unsigned domain = 74;
    const auto first = first_data_port(domain);
    const auto skill = expect(bind_udp(loopback, uint16_t(first - 1)));
    const auto port = expect(reach_port::open(io, {loopback, domain, "token"}));
    CHECK(port->port() == first + 2);
    CHECK(first_data_port_beside(port->port()) == first);
    // The next skill finds its port free.
    const auto next = expect(bind_udp(loopback, uint16_t(first + 1)));
    // The last row is that of the first port.
    const auto found = try_goal(io, {"arm", "127.0.0.1:1", "", port->port()});
    CHECK(found.at("data") == "found");
    ::close(skill.fd);
    ::close(next.fd);
  }
  io.stop();
}

TEST_CASE("where nobody listens, that is told, and why", "[reach]") {
  io_thread io{[](const std::string&) {}};
  reach_goal goal;
  {
    const reachable_node arm{io, "token"};
    goal = arm.goal("arm");
    goal.discovery_server = "127.0.0.1:1";
  }
  const auto found = try_goal(io, goal);
  for (const auto* way : {"session", "beat", "discovery", "data", "large"}) {
    INFO(way);
    CHECK(found.at(way) == "closed");
  }
  io.stop();
}

TEST_CASE("a node of another site does not answer", "[reach]") {
  io_thread io{[](const std::string&) {}};
  {
    const reachable_node arm{io, "another token"};
    const auto found = try_goal(io, arm.goal("arm"));
    CHECK(found.at("beat") == "silent");
    CHECK(found.at("data") == "silent");
    CHECK(arm.sockets.heartbeat->counters().malformed > 0);
  }
  io.stop();
}

namespace {

/// Descriptors that a program which is started now would have too.
std::set<int> inherited_descriptors() {
  std::set<int> result;
  for (const auto& x : std::filesystem::directory_iterator{"/proc/self/fd"}) {
    const auto fd = std::stoi(x.path().filename().string());
    const int flags = ::fcntl(fd, F_GETFD);
    if (flags >= 0 && (flags & FD_CLOEXEC) == 0)
      result.insert(fd);
  }
  return result;
}

} // namespace

TEST_CASE("no program that is started meanwhile gets a socket of a question",
          "[reach]") {
  const auto before = inherited_descriptors();
  io_thread io{[](const std::string&) {}};
  {
    // Nobody answers at once who does not know the token.
    const reachable_node arm{io, "another token"};
    auto goal = arm.goal("arm");
    goal.discovery_server = "127.0.0.1:1";
    inbox<std::vector<reach_row>> reported;
    try_to_reach(
        {io.core(), loopback, reach_key("token")}, {goal},
        [&](std::vector<reach_row> rows) { reported.put(std::move(rows)); });
    settle(io);
    CHECK(inherited_descriptors() == before);
    reported.take();
  }
  io.stop();
}
