#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/limits.hpp"
#include "discovery_fixture.hpp"

#include <arpa/inet.h>
#include <array>
#include <atomic>
#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

using namespace roscell;
using namespace roscell::test;

namespace {

/// A participant whose property names a version of discovery servers that is
/// no number.
std::vector<std::uint8_t> poisoned_question() {
  auto bytes = probe_question(make_probe_prefix(), sockaddr_in{});
  const std::string type = "PARTICIPANT_TYPE";
  auto at = std::search(bytes.begin(), bytes.end(), type.begin(), type.end());
  REQUIRE(at != bytes.end());
  // The name DS_VERSION, 11 bytes with its zero, padded to 12; then a value.
  const std::string poison{"\x0b\0\0\0DS_VERSION\0\0\x02\0\0\0x\0\0\0", 24};
  std::copy(poison.begin(), poison.end(), at - 4);
  // Who only asks is answered without Fast DDS.
  const std::string name = probe_name;
  at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  REQUIRE(at != bytes.end());
  *at = 'R';
  return bytes;
}

void send_to(std::uint16_t port, const std::vector<std::uint8_t>& bytes) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sendto(fd, bytes.data(), bytes.size(), 0,
         reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  ::close(fd);
}

cell_server_options with_remote(std::uint16_t port, std::uint8_t id) {
  auto result = local_server(2, "");
  result.remote = remote_server{"127.0.0.1", port, id};
  return result;
}

/// Passes on what comes for a server.
class relay {
public:
  explicit relay(std::uint16_t to)
      : to_(*to_socket_address("127.0.0.1", to)),
        socket_(std::get<udp_socket>(udp_socket::bind("127.0.0.1", 0))) {}

  std::uint16_t port() const {
    return ntohs(socket_.local().sin_port);
  }

  /// Until nothing has come for a while; false if that takes too long.
  bool falls_silent() {
    constexpr int while_ms = 400;
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::seconds{20};
    std::array<char, 65536> datagram{};
    while (std::chrono::steady_clock::now() < end) {
      pollfd waiting{socket_.fd(), POLLIN, 0};
      if (::poll(&waiting, 1, while_ms) == 0)
        return true;
      const auto size = recv(socket_.fd(), datagram.data(), datagram.size(), 0);
      if (size > 0)
        sendto(socket_.fd(), datagram.data(), static_cast<std::size_t>(size), 0,
               reinterpret_cast<const sockaddr*>(&to_), sizeof(to_));
    }
    return false;
  }

private:
  sockaddr_in to_;
  udp_socket socket_;
};

/// Threads that leave this process's others no time.
class crowd {
public:
  explicit crowd(std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      threads_.emplace_back([this] {
        while (!over_)
          continue;
      });
  }

  ~crowd() {
    over_ = true;
    for (auto& thread : threads_)
      thread.join();
  }

private:
  std::atomic<bool> over_{false};
  std::vector<std::thread> threads_;
};

} // namespace

TEST_CASE("a discovery server on port 0 says which port it took",
          "[discovery]") {
  auto server = must_open(local_server(1, ""));
  CHECK(server->port() != 0);
}

TEST_CASE("what a discovery server knows is known as long as it is there",
          "[discovery]") {
  auto options = local_server(1, "");
  options.graph = std::make_shared<ros_graph>();
  auto server = must_open(options);
  CHECK(options.graph->is_served());
  options.graph->name_participant({1}, "/");
  options.graph->add({1}, {"rt/x", "a::msg::dds_::B_", true, true, "", ""});
  server->close();
  CHECK_FALSE(options.graph->is_served());
  CHECK(options.graph->endpoints().empty());
  server = must_open(options);
  CHECK(options.graph->is_served());
}

TEST_CASE("a discovery server names the port that is in use", "[discovery]") {
  auto first = must_open(local_server(1, ""));
  auto options = local_server(2, "");
  options.port = first->port();
  auto error = error_of(cell_server::open(options));
  CHECK(error.code == error_code::conflict);
  CHECK(error.message
        == "UDP port " + std::to_string(first->port())
               + " on 127.0.0.1 is in use");
}

TEST_CASE("a discovery server refuses an address of another host and lists "
          "this host's",
          "[discovery]") {
  // 192.0.2.0/24 is for documentation; 127.0.0.12 can be bound, but belongs
  // to no interface.
  for (const char* address :
       {"192.0.2.9", "127.0.0.12", "0.0.0.0", "::1", "x"}) {
    auto options = local_server(1, "");
    options.address = address;
    auto error = error_of(cell_server::open(options));
    CHECK(error.code == error_code::unreachable);
    CHECK(error.message
          == std::string{address} + " is not an address of this host");
    CHECK(error.hint.find("lo 127.0.0.1") != std::string::npos);
  }
}

TEST_CASE("a discovery server refuses options out of bounds", "[discovery]") {
  auto too_long = local_server(
      1, std::string(limits::discovery::announcement_bytes + 1, 'x'));
  CHECK(error_of(cell_server::open(too_long)).message
        == "an announcement of 1025 bytes is over the limit of 1024");
  auto domain = local_server(1, "");
  domain.domain_id = 233;
  CHECK(error_of(cell_server::open(domain)).message
        == "ROS domain 233 is over 232");
  auto lease = local_server(1, "");
  lease.announcement_period = lease.lease;
  CHECK(error_of(cell_server::open(lease)).code
        == error_code::schema_violation);
}

TEST_CASE("a discovery server can run in the highest ROS domain",
          "[discovery]") {
  auto options = local_server(1, "high");
  options.domain_id = 232;
  auto server = must_open(options);
  diary seen;
  auto inquiry = must_open(asking(server->port()), writing_to(seen));
  CHECK(seen.wait_for("1 high"));
}

TEST_CASE("a discovery server reports who registers, not those who only ask",
          "[discovery]") {
  diary clients;
  diary answers;
  auto server = must_open(local_server(1, "hi"), [&](const sighting& seen) {
    clients.add((seen.what == sighting::kind::appeared ? "+" : "-")
                + seen.announcement);
  });
  auto inquiry = must_open(asking(server->port()), writing_to(answers));
  REQUIRE(answers.wait_for("1 hi"));
  auto options = with_remote(server->port(), 1);
  options.announcement = "member";
  auto member = must_open(options);
  member->meet(1);
  REQUIRE(clients.wait_for("+member"));
  CHECK(clients.entries() == std::vector<std::string>{"+member"});
}

TEST_CASE("a discovery server survives a participant that Fast DDS chokes on",
          "[discovery]") {
  auto server = must_open(local_server(1, "alive"));
  send_to(server->port(), poisoned_question());
  send_to(server->port(), {'R', 'T', 'P', 'S'});
  diary seen;
  auto inquiry = must_open(asking(server->port()), writing_to(seen));
  CHECK(seen.wait_for("1 alive"));
}

TEST_CASE("a discovery server can be closed twice", "[discovery]") {
  auto server = must_open(local_server(1, ""));
  server->close();
  server->close();
  CHECK_FALSE(server->update_announcement("late"));
}

TEST_CASE("a discovery server registers with its remote when that is there",
          "[discovery]") {
  diary clients;
  auto remote = must_open(local_server(1, ""), [&](const sighting& seen) {
    if (server_id_of(seen.prefix))
      clients.add(std::to_string(*server_id_of(seen.prefix)));
  });
  auto server = must_open(with_remote(remote->port(), 1));
  CHECK(clients.entries().empty());
  server->meet(1);
  CHECK(clients.wait_for("2"));
}

TEST_CASE("a discovery server that has registered tells its remote no more",
          "[discovery]") {
  diary clients;
  auto remote = must_open(local_server(1, ""), [&](const sighting& seen) {
    if (server_id_of(seen.prefix))
      clients.add(std::to_string(*server_id_of(seen.prefix)));
  });
  relay between{remote->port()};
  auto server = must_open(with_remote(between.port(), 1));
  server->meet(1);
  CHECK(between.falls_silent());
  CHECK(clients.wait_for("2"));
}

TEST_CASE("a discovery server with a remote starts where no thread gets time",
          "[discovery]") {
  const crowd busy{64};
  for (int i = 0; i < 4; ++i)
    must_open(with_remote(9, 1))->meet(1);
}
