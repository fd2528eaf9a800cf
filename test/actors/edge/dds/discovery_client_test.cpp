#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/discovery_address.hpp"
#include "actors/house/limits.hpp"
#include "discovery_fixture.hpp"

#include <atomic>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("a client that knows an address alone finds a server of any id",
          "[discovery]") {
  for (int id : {0, 7, 255}) {
    auto number = static_cast<std::uint8_t>(id);
    auto server = must_open(local_server(number, "hello"));
    diary seen;
    auto client = must_open(client_of(server->port()), writing_to(seen));
    CHECK(seen.wait_for(std::to_string(id) + " hello"));
  }
}

TEST_CASE("clients of two servers in one process keep them apart",
          "[discovery]") {
  auto one = must_open(local_server(1, "one"));
  auto two = must_open(local_server(2, "two"));
  diary of_one;
  diary of_two;
  auto a = must_open(client_of(one->port()), writing_to(of_one));
  auto b = must_open(client_of(two->port()), writing_to(of_two));
  CHECK(of_one.wait_for("1 one"));
  CHECK(of_two.wait_for("2 two"));
}

TEST_CASE("a server's new announcement reaches its clients", "[discovery]") {
  auto server = must_open(local_server(3, "old"));
  diary seen;
  auto client = must_open(client_of(server->port()), writing_to(seen));
  REQUIRE(seen.wait_for("3 old"));
  CHECK_FALSE(server->update_announcement("new"));
  CHECK(seen.wait_for("3 new"));
  // One who comes later hears only the new one.
  diary later;
  auto other = must_open(client_of(server->port()), writing_to(later));
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
  auto client = must_open(client_of(server->port()), writing_to(seen));
  CHECK(seen.wait_for(
      "3 " + std::string(limits::discovery::announcement_bytes, 'y')));
}

TEST_CASE("a client whose server is not there says why and finds it later",
          "[discovery]") {
  std::uint16_t port = must_open(local_server(4, ""))->port();
  diary seen;
  auto client = must_open(client_of(port), writing_to(seen));
  REQUIRE(seen.wait_for("nothing listens on UDP 127.0.0.1:"
                        + std::to_string(port)));
  auto options = local_server(4, "at last");
  options.port = port;
  auto server = must_open(options);
  CHECK(seen.wait_for("4 at last"));
}

TEST_CASE("a client notices that its server ends and finds the next one",
          "[discovery]") {
  auto options = local_server(5, "first");
  auto server = must_open(options);
  options.port = server->port();
  diary seen;
  auto client = must_open(client_of(options.port), writing_to(seen));
  REQUIRE(seen.wait_for("5 first"));
  server->close();
  REQUIRE(seen.wait_for("lost"));
  // The next one may be another coordinator with another id.
  options.server_id = 6;
  options.announcement = "second";
  server = must_open(options);
  CHECK(seen.wait_for("6 second"));
}

TEST_CASE("a client needs no well-known port", "[discovery]") {
  // As many nodes on this address as Fast DDS would look for places.
  std::vector<udp_socket> crowd;
  for (unsigned place = 60; place < 170; ++place) {
    auto bound = udp_socket::bind("127.0.0.1",
                                  static_cast<std::uint16_t>(7410 + 2 * place));
    if (auto* taken = std::get_if<udp_socket>(&bound))
      crowd.push_back(std::move(*taken));
  }
  auto server = must_open(local_server(9, "hello"));
  diary seen;
  auto client = must_open(client_of(server->port()), writing_to(seen));
  CHECK(seen.wait_for("9 hello"));
}

TEST_CASE("a client that renews hears of its server again", "[discovery]") {
  auto server = must_open(local_server(8, "hello"));
  diary seen;
  auto client = must_open(client_of(server->port()), writing_to(seen));
  REQUIRE(seen.wait_for("8 hello"));
  client->renew();
  CHECK(seen.wait_for("8 hello", 2));
  CHECK(seen.entries() == std::vector<std::string>{"8 hello", "8 hello"});
}

TEST_CASE("a closed client is silent, at whatever moment it closes",
          "[discovery]") {
  auto server = must_open(local_server(9, "hello"));
  for (int i = 0; i < 30; ++i) {
    std::atomic<bool> closed{false};
    std::atomic<bool> late{false};
    std::atomic<int> calls{0};
    cell_client_events events;
    events.on_server = [&](const server_sighting&) {
      late = late || closed;
      ++calls;
    };
    auto client = must_open(client_of(server->port()), events);
    // Some close before they are registered, some while, some after.
    for (int spin = 0; spin < i * 20000 && calls == 0; ++spin)
      std::atomic_thread_fence(std::memory_order_seq_cst);
    client->close();
    closed = true;
    server->update_announcement("hello " + std::to_string(i));
    CHECK_FALSE(late);
  }
}

TEST_CASE("a client refuses options that cannot work", "[discovery]") {
  auto options = client_of(11811);
  for (const char* address :
       {"", "localhost", "0.0.0.0", "10.0.0", "224.0.0.1"}) {
    options.server_address = address;
    CHECK(error_of(cell_client::open(options, {})).code
          == error_code::schema_violation);
  }
  options = client_of(0);
  CHECK(error_of(cell_client::open(options, {})).message
        == "\"127.0.0.1:0\" is no IPv4 address and port");
  options = client_of(11811);
  options.address = "192.0.2.9";
  auto error = error_of(cell_client::open(options, {}));
  CHECK(error.code == error_code::unreachable);
  CHECK(error.hint.find("lo 127.0.0.1") != std::string::npos);
}
