#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_participant.hpp"
#include "actors/edge/dds/limits.hpp"
#include "discovery_fixture.hpp"

#include <algorithm>
#include <atomic>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("who knows an address alone finds a server of any id",
          "[discovery]") {
  for (int id : {0, 7, 255}) {
    auto number = static_cast<std::uint8_t>(id);
    auto server = must_open(local_server(number, "hello"));
    diary seen;
    auto inquiry = must_open(asking(server->port()), writing_to(seen));
    CHECK(seen.wait_for(std::to_string(id) + " hello"));
  }
}

TEST_CASE("who asks two servers of one process keeps them apart",
          "[discovery]") {
  auto one = must_open(local_server(1, "one"));
  auto two = must_open(local_server(2, "two"));
  diary of_one;
  diary of_two;
  auto a = must_open(asking(one->port()), writing_to(of_one));
  auto b = must_open(asking(two->port()), writing_to(of_two));
  CHECK(of_one.wait_for("1 one"));
  CHECK(of_two.wait_for("2 two"));
}

TEST_CASE("a server's new announcement reaches those who ask", "[discovery]") {
  auto server = must_open(local_server(3, "old"));
  diary seen;
  auto inquiry = must_open(asking(server->port()), writing_to(seen));
  REQUIRE(seen.wait_for("3 old"));
  CHECK_FALSE(server->update_announcement("new"));
  CHECK(seen.wait_for("3 new"));
  // One who comes later hears only the new one.
  diary later;
  auto other = must_open(asking(server->port()), writing_to(later));
  CHECK(later.wait_for("3 new"));
  CHECK(later.entries().size() == 1);
}

TEST_CASE("an announcement over the limit is refused and changes nothing",
          "[discovery]") {
  auto server = must_open(local_server(3, "old"));
  auto error = server->update_announcement(
      std::string(limits::discovery::announcement_bytes + 1, 'x'));
  REQUIRE(error);
  CHECK(error->code == error_code::schema_violation);
  CHECK_FALSE(server->update_announcement(
      std::string(limits::discovery::announcement_bytes, 'y')));
  diary seen;
  auto inquiry = must_open(asking(server->port()), writing_to(seen));
  CHECK(seen.wait_for(
      "3 " + std::string(limits::discovery::announcement_bytes, 'y')));
}

TEST_CASE("who asks where no server is finds the one that comes",
          "[discovery]") {
  std::uint16_t port = must_open(local_server(4, ""))->port();
  diary seen;
  auto inquiry = must_open(asking(port), writing_to(seen));
  auto options = local_server(4, "at last");
  options.port = port;
  auto server = must_open(options);
  CHECK(seen.wait_for("4 at last"));
}

TEST_CASE("who asks finds the next server at an address", "[discovery]") {
  auto options = local_server(5, "first");
  auto server = must_open(options);
  options.port = server->port();
  diary seen;
  auto inquiry = must_open(asking(options.port), writing_to(seen));
  REQUIRE(seen.wait_for("5 first"));
  server->close();
  // The next one may be another coordinator with another id.
  options.server_id = 6;
  options.announcement = "second";
  server = must_open(options);
  CHECK(seen.wait_for("6 second"));
}

TEST_CASE("a closed inquiry is silent, at whatever moment it closes",
          "[discovery]") {
  auto server = must_open(local_server(9, "hello"));
  for (int i = 0; i < 30; ++i) {
    std::atomic<bool> closed{false};
    std::atomic<bool> late{false};
    std::atomic<int> calls{0};
    auto inquiry =
        must_open(asking(server->port()), [&](const server_sighting&) {
          late = late || closed;
          ++calls;
        });
    // Some close before they have an answer, some while it comes, some after.
    for (int spin = 0; spin < i * 20000 && calls == 0; ++spin)
      std::atomic_thread_fence(std::memory_order_seq_cst);
    inquiry->close();
    closed = true;
    server->update_announcement("hello " + std::to_string(i));
    CHECK_FALSE(late);
  }
}

TEST_CASE("an inquiry refuses options that cannot work", "[discovery]") {
  auto options = asking(11811);
  for (const char* address :
       {"", "localhost", "0.0.0.0", "10.0.0", "224.0.0.1"}) {
    options.server_address = address;
    CHECK(error_of(server_inquiry::open(options, {})).code
          == error_code::schema_violation);
  }
  options = asking(0);
  CHECK(error_of(server_inquiry::open(options, {})).message
        == "\"127.0.0.1:0\" is no IPv4 address and port");
  options = asking(11811);
  options.address = "192.0.2.9";
  auto error = error_of(server_inquiry::open(options, {}));
  CHECK(error.code == error_code::unreachable);
  CHECK(error.hint.find("lo 127.0.0.1") != std::string::npos);
}

TEST_CASE("who asks finds a server that takes it for a client") {
  // As those of earlier versions are: one of Fast DDS, behind no guard.
  prepare_dds_environment();
  participant_settings settings;
  settings.address = "127.0.0.1";
  settings.announcement = "of an earlier version";
  settings.serves_programs = true;
  // It says nothing by itself before the test is over.
  settings.lease = std::chrono::hours{2};
  settings.announcement_period = std::chrono::hours{1};
  const auto port =
      ntohs(std::get<udp_socket>(udp_socket::bind(settings.address, 0))
                .local()
                .sin_port);
  auto attributes = make_attributes(settings, port);
  const auto prefix = server_prefix(9);
  std::copy(prefix.begin(), prefix.end(), attributes.prefix.value);
  attributes.builtin.discovery_config.discoveryProtocol =
      eprosima::fastrtps::rtps::DiscoveryProtocol_t::SERVER;
  attributes.builtin.discovery_config.initial_announcements.count = 0;
  const auto server = rtps_participant::create(0, attributes, {});
  REQUIRE(server);
  diary seen;
  const auto inquiry = must_open(asking(port), writing_to(seen));
  CHECK(seen.wait_for("9 of an earlier version"));
}
