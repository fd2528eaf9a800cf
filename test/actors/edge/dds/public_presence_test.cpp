#include "actors/edge/dds/limits.hpp"
#include "actors/edge/dds/public_presence.hpp"
#include "discovery_fixture.hpp"

#include <algorithm>
#include <set>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// Other test runs on this host must not be heard, so each process has domains
/// of its own; `offset` tells two of them apart.
std::uint32_t own_domain(std::uint32_t offset = 0) {
  return 1 + 2 * (static_cast<std::uint32_t>(getpid()) % 100) + offset;
}

announcement saying(const std::string& role, const std::string& node) {
  announcement result;
  result.role = role;
  result.node = node;
  result.uuid = std::to_string(getpid()) + '-' + node;
  return result;
}

presence_options at_home(const announcement& says) {
  prepare_dds_environment();
  presence_options result;
  result.address = "127.0.0.1";
  result.domain_id = own_domain();
  result.announcement = encode(says);
  return result;
}

presence_events writing_presence_to(diary& to) {
  presence_events result;
  result.on_seen = [&to](const announcement& x) {
    to.add('+' + x.role + ' ' + x.node + ' ' + std::to_string(x.epoch));
  };
  result.on_gone = [&to](const announcement& x) {
    to.add('-' + x.role + ' ' + x.node + ' ' + std::to_string(x.epoch));
  };
  return result;
}

std::unique_ptr<public_presence> must_open(const presence_options& options,
                                           presence_events events = {}) {
  auto result = public_presence::open(options, std::move(events));
  if (auto* error = std::get_if<edge_error>(&result))
    FAIL(error->message);
  return std::get<0>(std::move(result));
}

/// What a participant of other software sends to announce the least.
std::vector<std::uint8_t> foreign_announcement() {
  sockaddr_in at_home{};
  at_home.sin_family = AF_INET;
  at_home.sin_port = htons(9);
  at_home.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto bytes = probe_question(make_probe_prefix(), at_home);
  const std::string name = probe_name;
  auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  REQUIRE(at != bytes.end());
  // A name and user data are both a length and bytes: PID_USER_DATA is 0x2c.
  // These take as much room as the name with its padding.
  const std::string data = "roscell=1.0;x=1;";
  at[-8] = 0x2c;
  at[-4] = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), at);
  return bytes;
}

/// Sends a datagram over the loopback interface.
void send_to(const char* address, std::uint16_t port,
             const std::vector<std::uint8_t>& bytes) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  inet_pton(AF_INET, address, &to.sin_addr);
  int fd = socket(AF_INET, SOCK_DGRAM, 0);
  const in_addr loopback{htonl(INADDR_LOOPBACK)};
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof(loopback));
  auto sent = sendto(fd, bytes.data(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  ::close(fd);
  CHECK(sent == static_cast<ssize_t>(bytes.size()));
}

} // namespace

TEST_CASE("a survey takes longer on a host that is busy or slow") {
  using namespace std::chrono_literals;
  CHECK(survey_span(60ms, 0ms) == 60ms);
  CHECK(survey_span(60ms, 2400us) == 60ms);
  CHECK(survey_span(60ms, 10ms) == 250ms);
  CHECK(survey_span(60ms, 40ms) == 1s);
  CHECK(survey_span(60ms, 1h) == 1s);
  CHECK(survey_span(5s, 40ms) == 5s);
}

TEST_CASE("two presences of one process see each other, not themselves",
          "[presence]") {
  diary first_saw;
  diary second_saw;
  auto first = must_open(at_home(saying("coordinator", "first")),
                         writing_presence_to(first_saw));
  auto second = must_open(at_home(saying("independent", "second")),
                          writing_presence_to(second_saw));
  CHECK(second_saw.wait_for("+coordinator first 0"));
  CHECK(first_saw.wait_for("+independent second 0"));
  CHECK(first->port() != second->port());
  second->close();
  CHECK(first_saw.wait_for("-independent second 0"));
  CHECK(first_saw.entries().size() == 2);
  CHECK(second_saw.entries().size() == 1);
}

TEST_CASE("a presence tells each change once, and its last word when it goes",
          "[presence]") {
  diary seen;
  auto watcher = must_open(at_home(saying("coordinator", "watcher")),
                           writing_presence_to(seen));
  auto says = saying("independent", "changing");
  auto changing = must_open(at_home(says));
  REQUIRE(seen.wait_for("+independent changing 0"));
  says.epoch = 5;
  CHECK_FALSE(changing->update(encode(says)));
  REQUIRE(seen.wait_for("+independent changing 5"));
  says.role = "orphaned";
  says.epoch = 6;
  CHECK_FALSE(changing->update(encode(says)));
  REQUIRE(seen.wait_for("+orphaned changing 6"));
  changing.reset();
  REQUIRE(seen.wait_for("-orphaned changing 6"));
  CHECK(seen.entries().size() == 4);
}

TEST_CASE("a participant that announces another node ends the former one",
          "[presence]") {
  diary seen;
  auto watcher = must_open(at_home(saying("coordinator", "watcher")),
                           writing_presence_to(seen));
  auto turncoat = must_open(at_home(saying("coordinator", "one")));
  REQUIRE(seen.wait_for("+coordinator one 0"));
  CHECK_FALSE(turncoat->update(encode(saying("coordinator", "two"))));
  REQUIRE(seen.wait_for("+coordinator two 0"));
  CHECK(seen.wait_for("-coordinator one 0"));
  CHECK_FALSE(turncoat->update(encode(saying("independent", "two"))));
  CHECK(seen.wait_for("-coordinator two 0"));
}

TEST_CASE("participants that announce nothing of ours are not seen",
          "[presence]") {
  diary seen;
  auto watcher = must_open(at_home(saying("coordinator", "watcher")),
                           writing_presence_to(seen));
  auto foreign = at_home({});
  foreign.announcement = "enclave=/;";
  auto unauthenticated_peer = must_open(foreign);
  foreign.announcement = "roscell=1.0;role=independent";
  auto damaged = must_open(foreign);
  auto known = must_open(at_home(saying("independent", "known")));
  REQUIRE(seen.wait_for("+independent known 0"));
  // What was an unauthenticated peer can become one of us, and the reverse is
  // ignored.
  CHECK_FALSE(
      unauthenticated_peer->update(encode(saying("independent", "convert"))));
  REQUIRE(seen.wait_for("+independent convert 0"));
  CHECK_FALSE(unauthenticated_peer->update("enclave=/;"));
  unauthenticated_peer.reset();
  REQUIRE(seen.wait_for("-independent convert 0"));
  CHECK(seen.entries().size() == 3);
}

TEST_CASE("a peer's address replaces multicast, in both directions",
          "[presence]") {
  diary here_saw;
  diary there_saw;
  // Another domain has another multicast port, and other places.
  auto there_says = at_home(saying("coordinator", "there"));
  there_says.domain_id = own_domain(1);
  auto there = must_open(there_says, writing_presence_to(there_saw));
  auto here_says = at_home(saying("independent", "here"));
  here_says.peers = {"127.0.0.1:" + std::to_string(there->port())};
  auto here = must_open(here_says, writing_presence_to(here_saw));
  CHECK(here_saw.wait_for("+coordinator there 0"));
  CHECK(there_saw.wait_for("+independent here 0"));
  // Multicast stays on beside peers.
  auto near = must_open(at_home(saying("independent", "near")));
  CHECK(here_saw.wait_for("+independent near 0"));
  auto changed = saying("coordinator", "there");
  changed.epoch = 3;
  CHECK_FALSE(there->update(encode(changed)));
  CHECK(here_saw.wait_for("+coordinator there 3"));
}

TEST_CASE("a presence takes only what is safe, by either way", "[presence]") {
  diary seen;
  auto watcher = must_open(at_home(saying("coordinator", "watcher")),
                           writing_presence_to(seen));
  auto group = static_cast<std::uint16_t>(7400 + 250 * own_domain());
  auto send_both = [&](const std::function<std::vector<std::uint8_t>()>& make) {
    send_to("127.0.0.1", watcher->port(), make());
    send_to("239.255.0.1", group, make());
  };
  // Fast DDS would pass over a submessage that it does not know.
  send_both([] {
    auto bytes = foreign_announcement();
    bytes.insert(bytes.end(), {0x30, 1, 4, 0, 0, 0, 0, 0});
    return bytes;
  });
  send_both(foreign_announcement);
  REQUIRE(seen.wait_for("+  0", 2));
  auto known = must_open(at_home(saying("independent", "known")));
  REQUIRE(seen.wait_for("+independent known 0"));
  CHECK(seen.entries().size() == 3);
}

TEST_CASE("a presence refuses options out of bounds", "[presence]") {
  auto refusal = [](auto change) {
    auto options = at_home({});
    change(options);
    return error_of(public_presence::open(options, {}));
  };
  using options = presence_options;
  CHECK(refusal([](options& x) { x.domain_id = 233; }).message
        == "ROS domain 233 is over 232");
  CHECK(refusal([](options& x) { x.lease = x.announcement_period; }).code
        == error_code::schema_violation);
  CHECK(refusal([](options& x) {
          x.announcement =
              std::string(limits::discovery::announcement_bytes + 1, 'x');
        }).code
        == error_code::schema_violation);
  auto elsewhere = refusal([](options& x) { x.address = "192.0.2.9"; });
  CHECK(elsewhere.code == error_code::unreachable);
  CHECK(elsewhere.message == "192.0.2.9 is not an address of this host");
  for (const char* peer : {"", "host", "10.0.0.1:", "10.0.0.1:0",
                           "10.0.0.1:65536", "10.0.0.1:1x", "239.255.0.1"}) {
    CAPTURE(peer);
    auto why = refusal([&](options& x) { x.peers = {peer}; });
    CHECK(why.code == error_code::schema_violation);
    CHECK(why.message == '"' + std::string{peer} + "\" is no peer");
  }
  auto presence = must_open(at_home({}));
  CHECK(presence->update(
      std::string(limits::discovery::announcement_bytes + 1, 'x')));
}

TEST_CASE("a presence can be closed twice, and told something then",
          "[presence]") {
  auto presence = must_open(at_home({}));
  presence->close();
  presence->close();
  CHECK_FALSE(presence->update("late"));
}

TEST_CASE("the first presences of a host take the places that peers try",
          "[presence]") {
  std::set<std::uint16_t> places;
  for (unsigned i = 0; i < limits::discovery::presence_places; ++i)
    places.insert(
        static_cast<std::uint16_t>(7400 + 250 * own_domain() + 10 + 2 * i));
  std::vector<std::unique_ptr<public_presence>> all;
  for (unsigned i = 0; i < limits::discovery::presence_places + 1; ++i) {
    all.push_back(must_open(at_home({})));
    CHECK((places.erase(all.back()->port()) == 1)
          == (i < limits::discovery::presence_places));
  }
}

TEST_CASE("presence, discovery server and inquiry work side by side",
          "[presence]") {
  diary members;
  diary seen;
  auto server = must_open(local_server(7, "cell"));
  auto inquiry = must_open(asking(server->port()), writing_to(members));
  auto first = must_open(at_home(saying("coordinator", "first")),
                         writing_presence_to(seen));
  auto second = must_open(at_home(saying("independent", "second")));
  CHECK(seen.wait_for("+independent second 0"));
  CHECK(members.wait_for("7 cell"));
  CHECK_FALSE(server->update_announcement("changed"));
  CHECK(members.wait_for("7 changed"));
  // The participants of the cell do not show on the public domain.
  CHECK(seen.entries().size() == 1);
}

TEST_CASE("a survey finds who is there already and ends when it is enough",
          "[presence]") {
  auto coordinator = must_open(at_home(saying("coordinator", "old")));
  auto begin = std::chrono::steady_clock::now();
  auto found = survey_site(at_home({}), 20s, [](const announcement& x) {
    return x.role == "coordinator";
  });
  CHECK(std::chrono::steady_clock::now() - begin < 10s);
  REQUIRE(std::holds_alternative<std::vector<announcement>>(found));
  REQUIRE(std::get<0>(found).size() == 1);
  CHECK(std::get<0>(found).front() == saying("coordinator", "old"));
}

TEST_CASE("a survey of an empty site ends with its span", "[presence]") {
  auto options = at_home({});
  auto found = survey_site(options, 50ms, {});
  REQUIRE(std::holds_alternative<std::vector<announcement>>(found));
  CHECK(std::get<0>(found).empty());
  options.address = "192.0.2.9";
  CHECK(error_of(survey_site(options, 50ms, {})).code
        == error_code::unreachable);
}
