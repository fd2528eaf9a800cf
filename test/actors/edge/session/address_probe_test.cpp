#include "actors/edge/dds/discovery_server.hpp"
#include "actors/edge/dds/discovery_setup.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/session/address_probe.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace roscell;
using namespace roscell::test::wire;

namespace {

constexpr auto loopback = "127.0.0.1";

constexpr auto hello = R"({"type":"node_hello","node":"head",
  "role":"coordinator","state":"member","version":"0.1.0","cell":"lab",
  "discovery_server":"127.0.0.1:11811","domain_id":0,"public_domain":99})";

/// A UDP port that somebody holds and nobody answers at.
class mute_port {
public:
  mute_port() : fd_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(fd_, reinterpret_cast<const sockaddr*>(&at), sizeof(at));
  }

  ~mute_port() {
    ::close(fd_);
  }

  mute_port(const mute_port&) = delete;
  mute_port& operator=(const mute_port&) = delete;

  uint16_t port() const {
    sockaddr_in at{};
    socklen_t size = sizeof(at);
    getsockname(fd_, reinterpret_cast<sockaddr*>(&at), &size);
    return ntohs(at.sin_port);
  }

private:
  int fd_;
};

/// A server that gives one answer to all.
std::unique_ptr<http_server> serve(io_thread& io, const std::string& body) {
  http_server_options options;
  options.address = loopback;
  options.port = 0;
  options.public_paths = {hello_path};
  options.handler = [body](const http_request&, const responder& answer) {
    answer.reply(200, json_content, body);
  };
  auto opened = http_server::start(io, std::move(options));
  REQUIRE(std::holds_alternative<std::unique_ptr<http_server>>(opened));
  return std::get<std::unique_ptr<http_server>>(std::move(opened));
}

server_probed probe_server_port(io_thread& io, uint16_t port) {
  inbox<server_probed> found;
  probe_address(io.core(), loopback, {loopback, port}, nullptr,
                [&](server_probed x) { found.put(std::move(x)); });
  return found.take();
}

} // namespace

TEST_CASE("a closed port is told from one that is silent") {
  io_thread io;
  uint16_t free = 0;
  {
    const mute_port held;
    CHECK(probe_server_port(io, held.port()).discovery == port_answer::silent);
    free = held.port();
  }
  const auto found = probe_server_port(io, free);
  CHECK(found.discovery == port_answer::closed);
  REQUIRE(found.tcp.size() == 2);
  CHECK(found.tcp[0].port == free);
  CHECK(found.tcp[0].answer == port_answer::closed);
  CHECK(found.tcp[1].port == 8420);
}

TEST_CASE("a discovery server is recognised by its answer") {
  prepare_dds_environment();
  cell_server_options options;
  options.address = loopback;
  options.port = 0;
  auto opened = cell_server::open(options);
  const auto& server = std::get<std::unique_ptr<cell_server>>(opened);
  io_thread io;
  CHECK(probe_server_port(io, server->port()).discovery == port_answer::found);
}

TEST_CASE("who introduces itself as a node is found by its HTTP port") {
  io_thread io;
  const auto node = serve(io, hello);
  const auto found = probe_server_port(io, node->port());
  CHECK(found.tcp[0].answer == port_answer::found);
  REQUIRE(found.tcp[0].hello.size() == 1);
  CHECK(found.tcp[0].hello[0].node == "head");
  CHECK(found.tcp[0].hello[0].discovery_server == "127.0.0.1:11811");
}

TEST_CASE("what is no introduction of a node makes an unauthenticated peer") {
  io_thread io;
  for (const auto* body :
       {"", "hello", "{}", R"({"type":"node_hello"})",
        R"({"type":"error","error":{"code":"internal","message":"x",)"
        R"("where":"","hint":""}})"}) {
    INFO(body);
    const auto other = serve(io, body);
    const auto found = probe_server_port(io, other->port());
    CHECK(found.tcp[0].answer == port_answer::unauthenticated_peer);
    CHECK(found.tcp[0].hello.empty());
  }
}
