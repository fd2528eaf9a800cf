#include "actors/edge/http/limits.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include <dirent.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell::test::wire {

namespace {

/// The last bytes of an error's body.
constexpr const char* end_of_error = "\"error\"}";

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// The highest descriptor in use, and so what a limit must exceed.
int highest_fd() {
  int result = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (const auto* entry = ::readdir(folder))
    result = std::max(result, std::atoi(entry->d_name));
  ::closedir(folder);
  return result;
}

/// Whether the server closes one of these, although nobody reads what it said.
bool closes_one_of(const std::vector<raw_client>& clients) {
  std::vector<pollfd> fds;
  for (const auto& client : clients)
    fds.push_back({client.fd(), 0, 0});
  const auto patience_ms = std::chrono::milliseconds{patience}.count();
  return ::poll(fds.data(), fds.size(), static_cast<int>(patience_ms)) > 0;
}

/// No new descriptor can be opened while this lives.
class no_descriptors {
public:
  no_descriptors() {
    // Gaps below the highest one are filled, else they could still be used.
    const int top = highest_fd() + 1;
    ::getrlimit(RLIMIT_NOFILE, &before_);
    auto now = before_;
    now.rlim_cur = static_cast<rlim_t>(top);
    ::setrlimit(RLIMIT_NOFILE, &now);
    for (int fd = ::dup(0); fd >= 0; fd = ::dup(0))
      fillers_.push_back(fd);
  }

  no_descriptors(const no_descriptors&) = delete;
  no_descriptors& operator=(const no_descriptors&) = delete;

  ~no_descriptors() {
    for (const int fd : fillers_)
      ::close(fd);
    ::setrlimit(RLIMIT_NOFILE, &before_);
  }

private:
  rlimit before_{};
  std::vector<int> fillers_;
};

/// Nobody waits on the Unix socket.
http_limits for_one_local_client() {
  http_limits result;
  result.local = 1;
  result.waiting = 0;
  return result;
}

} // namespace

TEST_CASE("a body of 100 MB is refused before it is read") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send("POST /v1/requests HTTP/1.1\r\nAuthorization: Bearer "
              + std::string{bearer} + "\r\nContent-Length: 100000000\r\n\r\n");
  const auto reply = client.read_until(end_of_error);
  CHECK(starts_with(reply, "HTTP/1.1 413 "));
  CHECK(reply.find("malformed_json") != std::string::npos);
  CHECK(reply.find("Connection: close") != std::string::npos);
}

TEST_CASE("a client that sends 100 MB regardless gets the refusal, too") {
  http_fixture node;
  const std::string body(100'000'000, 'x');
  const auto reply =
      expect(node.tcp_client().request("POST", "/v1/requests", body, {}));
  CHECK(reply.status == 413);
  raw_client client{node.socket_path()};
  client.send("POST / HTTP/1.1\r\nContent-Length: 100000000\r\n\r\n");
  CHECK_FALSE(client.send(body));
  CHECK(node.requests.size() == 0);
}

TEST_CASE("a body in chunks is refused once it is too long") {
  http_limits limits;
  limits.body_bytes = 1000;
  http_fixture node{limits};
  raw_client client{node.socket_path()};
  client.send("POST /echo HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n");
  const auto chunk = "1f4\r\n" + std::string(500, 'x') + "\r\n";
  client.send(chunk + chunk + chunk);
  CHECK(starts_with(client.read_until(end_of_error), "HTTP/1.1 413 "));
}

TEST_CASE("a body of exactly the limit is taken") {
  http_limits limits;
  limits.body_bytes = 1000;
  http_fixture node{limits};
  const std::string body(1000, 'x');
  const auto client = node.tcp_client();
  CHECK(expect(client.request("POST", "/echo", body, {})).status == 200);
  CHECK(expect(client.request("POST", "/echo", body + "x", {})).status == 413);
}

TEST_CASE("a header of 9 KiB is refused, with or without an end") {
  http_fixture node;
  raw_client client{node.socket_path()};
  client.send("GET /echo HTTP/1.1\r\nX: " + std::string(9 * 1024, 'x')
              + "\r\n\r\n");
  CHECK(starts_with(client.read_until(end_of_error), "HTTP/1.1 431 "));
  raw_client endless{node.socket_path()};
  endless.send("GET /" + std::string(9 * 1024, 'x'));
  CHECK(starts_with(endless.read_until(end_of_error), "HTTP/1.1 431 "));
}

TEST_CASE("a request that takes too long to arrive gets 408") {
  http_limits limits;
  limits.whole_request = 50ms;
  http_fixture node{limits};
  raw_client in_header{node.server->port()};
  in_header.send("GET /ec");
  CHECK(starts_with(in_header.read_to_end(), "HTTP/1.1 408 "));
  raw_client in_body{node.server->port()};
  in_body.send("POST /echo HTTP/1.1\r\nAuthorization: Bearer "
               + std::string{bearer} + "\r\nContent-Length: 10\r\n\r\nabc");
  CHECK(starts_with(in_body.read_to_end(), "HTTP/1.1 408 "));
}

TEST_CASE("bytes that trickle in do not extend the time for a request") {
  http_limits limits;
  limits.whole_request = 50ms;
  http_fixture node{limits};
  raw_client client{node.server->port()};
  const auto deadline = std::chrono::steady_clock::now() + patience;
  // Each read of the server is waited for, so it sees them one by one.
  while (!client.is_readable() && std::chrono::steady_clock::now() < deadline) {
    client.send("x");
    settle(node.io);
  }
  CHECK(starts_with(client.read_until(end_of_error), "HTTP/1.1 408 "));
}

TEST_CASE("who does not read that its body may come is closed without a word") {
  http_limits limits;
  limits.whole_request = 50ms;
  limits.write = 1h;
  http_fixture node{limits};
  std::string requests;
  for (int i = 0; i < 400; ++i)
    requests += "POST /echo HTTP/1.1\r\nExpect: 100-continue\r\n"
                "Content-Length: 1\r\n\r\nx";
  // Two words for each request fill the buffer of the socket in the end. Which
  // of the two finds no room depends on what was said before.
  std::vector<raw_client> clients;
  for (const auto* before : {"", "GET /echo HTTP/1.1\r\n\r\n"}) {
    clients.emplace_back(node.socket_path());
    clients.back().send(before + requests);
  }
  CHECK(closes_one_of(clients));
}

TEST_CASE("a client that never says a word is closed") {
  http_limits limits;
  limits.first_byte = 50ms;
  http_fixture node{limits};
  CHECK(raw_client{node.server->port()}.read_to_end().empty());
  CHECK(raw_client{node.socket_path()}.read_to_end().empty());
}

TEST_CASE("a connection that rests too long between requests is closed") {
  http_limits limits;
  limits.idle = 50ms;
  http_fixture node{limits};
  raw_client client{node.server->port()};
  client.send(get("/echo"));
  CHECK(starts_with(client.read_to_end(), "HTTP/1.1 200 OK\r\n"));
}

TEST_CASE("a request in progress has all the time its handler needs") {
  http_limits limits;
  limits.first_byte = limits.whole_request = limits.idle = limits.write = 20ms;
  http_fixture node{limits};
  raw_client client{node.server->port()};
  client.send(get("/slow"));
  const auto asked = node.requests.take();
  raw_client idle{node.server->port()};
  CHECK(idle.read_to_end().empty());
  raw_client late{node.server->port()};
  late.send("GET");
  CHECK(starts_with(late.read_to_end(), "HTTP/1.1 408 "));
  asked.answer.reply(200, "text/plain", "worth the wait");
  CHECK(client.read_to_end().find("worth the wait") != std::string::npos);
}

TEST_CASE("300 silent connections keep nobody out who speaks") {
  http_limits limits;
  limits.first_byte = 1h;
  http_fixture node{limits};
  std::vector<raw_client> crowd;
  for (int i = 0; i < 300; ++i)
    crowd.emplace_back(node.server->port());
  CHECK(expect(node.local_client().request("GET", "/echo", {}, {})).status
        == 200);
  CHECK(expect(node.tcp_client().request("GET", "/echo", {}, {})).status
        == 200);
  const auto closed =
      std::count_if(crowd.begin(), crowd.end(),
                    [](raw_client& client) { return client.is_closed(); });
  CHECK(closed >= 300 - static_cast<int>(limits.unauthenticated_peers));
}

TEST_CASE("the unauthenticated peer that was silent for longest makes room") {
  http_limits limits;
  limits.unauthenticated_peers = 2;
  http_fixture node{limits};
  raw_client first{node.server->port()};
  first.send("GET /healthz HTTP/1.1\r\n\r\n");
  first.read_until("tcp ");
  raw_client second{node.server->port()};
  second.send("GET /healthz HTTP/1.1\r\n\r\n");
  second.read_until("tcp ");
  first.send("GET /healthz HTTP/1.1\r\n\r\n");
  first.read_until("tcp ");
  raw_client third{node.server->port()};
  CHECK(second.read_to_end().empty());
  CHECK_FALSE(first.is_closed());
}

TEST_CASE(
    "unauthenticated peers may post little to a public path, others much") {
  http_fixture node;
  const auto post = [](const std::string& more, size_t size) {
    return "POST /healthz HTTP/1.1\r\n" + more + "Connection: close\r\n"
           + "Content-Length: " + std::to_string(size) + "\r\n\r\n"
           + std::string(size, 'x');
  };
  const auto token = "Authorization: Bearer " + std::string{bearer} + "\r\n";
  const auto little = limits::http::public_body_bytes;
  for (const auto& [more, size, status] :
       {std::tuple{std::string{}, little, "200"},
        std::tuple{std::string{}, little + 1, "413"},
        std::tuple{token, little + 1, "200"}}) {
    raw_client client{node.server->port()};
    client.send(post(more, size));
    CHECK(starts_with(client.read_to_end(), std::string{"HTTP/1.1 "} + status));
  }
}

TEST_CASE("who posts to a public path stays an unauthenticated peer with "
          "bounded bodies") {
  http_limits limits;
  limits.unauthenticated_peers = 1;
  limits.public_body_bytes = 8;
  http_fixture node{limits};
  const auto post = [](const std::string& path, const std::string& body) {
    return "POST " + path + " HTTP/1.1\r\nContent-Length: "
           + std::to_string(body.size()) + "\r\n\r\n" + body;
  };
  raw_client first{node.server->port()};
  for (const auto* body : {"{}", "12345678"}) {
    first.send(post("/healthz", body));
    const auto reply = first.read_until(std::string{"tcp "} + body);
    CHECK(starts_with(reply, "HTTP/1.1 200 "));
  }
  raw_client second{node.server->port()};
  CHECK(first.read_to_end().empty());
  second.send(post("/healthz", "123456789"));
  CHECK(starts_with(second.read_to_end(), "HTTP/1.1 413 "));
  // What only begins like a public path is none.
  for (const auto* path : {"/healthz/", "/healthz2", "//healthz", "/"}) {
    raw_client other{node.server->port()};
    other.send(post(path, "{}"));
    CHECK(starts_with(other.read_to_end(), "HTTP/1.1 401 "));
  }
  CHECK(node.requests.size() == 0);
}

TEST_CASE(
    "a client that showed its token is no unauthenticated peer any more") {
  http_limits limits;
  limits.unauthenticated_peers = 1;
  limits.trusted = 1;
  http_fixture node{limits};
  raw_client trusted{node.server->port()};
  trusted.send(get("/echo"));
  trusted.read_until("tcp ");
  raw_client unauthenticated_peer{node.server->port()};
  unauthenticated_peer.send("GET /healthz HTTP/1.1\r\n\r\n");
  unauthenticated_peer.read_until("tcp ");
  raw_client other{node.server->port()};
  CHECK(unauthenticated_peer.read_to_end().empty());
  other.send(get("/echo"));
  CHECK(starts_with(other.read_to_end(), "HTTP/1.1 503 "));
  trusted.send(get("/echo"));
  CHECK(starts_with(trusted.read_until("tcp "), "HTTP/1.1 200 "));
  // The place is free again once its holder has gone.
  trusted.close();
  std::string reply;
  while (!starts_with(reply, "HTTP/1.1 200 "))
    reply = [&] {
      raw_client again{node.server->port()};
      again.send(get("/echo", "Connection: close\r\n"));
      return again.read_to_end();
    }();
}

TEST_CASE("clients of the Unix socket wait for their turn") {
  http_limits limits;
  limits.local = 1;
  http_fixture node{limits};
  raw_client first{node.socket_path()};
  first.send("GET /echo HTTP/1.1\r\n\r\n");
  first.read_until("local ");
  raw_client second{node.socket_path()};
  second.send("GET /echo HTTP/1.1\r\n\r\n");
  raw_client gone{node.socket_path()};
  raw_client third{node.socket_path()};
  third.send("GET /echo HTTP/1.1\r\n\r\n");
  settle(node.io);
  CHECK_FALSE(second.is_readable());
  gone.close();
  first.close();
  CHECK(starts_with(second.read_until("local "), "HTTP/1.1 200 "));
  settle(node.io);
  CHECK_FALSE(third.is_readable());
  second.close();
  CHECK(starts_with(third.read_until("local "), "HTTP/1.1 200 "));
}

TEST_CASE("who waits too long for a turn is told so, with a hint") {
  http_limits limits;
  limits.local = 1;
  limits.turn = 50ms;
  http_fixture node{limits};
  raw_client first{node.socket_path()};
  first.send("GET /echo HTTP/1.1\r\n\r\n");
  first.read_until("local ");
  raw_client second{node.socket_path()};
  const auto reply = second.read_to_end();
  CHECK(starts_with(reply, "HTTP/1.1 503 "));
  CHECK(reply.find("ask again in a moment") != std::string::npos);
  first.send("GET /echo HTTP/1.1\r\n\r\n");
  CHECK(starts_with(first.read_until("local "), "HTTP/1.1 200 "));
}

TEST_CASE("200 requests at once on the Unix socket are all answered") {
  http_fixture node;
  std::vector<raw_client> crowd;
  for (int i = 0; i < 200; ++i) {
    crowd.emplace_back(node.socket_path());
    crowd.back().send("GET /echo HTTP/1.1\r\nConnection: close\r\n\r\n");
  }
  for (auto& client : crowd)
    REQUIRE(starts_with(client.read_to_end(), "HTTP/1.1 200 "));
}

TEST_CASE("a client of the Unix socket over all limits is told so") {
  http_fixture node{for_one_local_client()};
  raw_client first{node.socket_path()};
  first.send("GET /echo HTTP/1.1\r\n\r\n");
  first.read_until("local ");
  raw_client second{node.socket_path()};
  const auto reply = second.read_to_end();
  CHECK(starts_with(reply, "HTTP/1.1 503 "));
  CHECK(reply.find("too many clients") != std::string::npos);
}

TEST_CASE("a client of the Unix socket over all limits reads why, whenever it "
          "has written its request") {
  http_fixture node{for_one_local_client()};
  raw_client first{node.socket_path()};
  first.send("GET /echo HTTP/1.1\r\n\r\n");
  first.read_until("local ");
  raw_client late{node.socket_path()};
  // It has been answered before it says what it wants.
  CHECK(starts_with(late.read_until("too many clients"), "HTTP/1.1 503 "));
  CHECK(late.send("GET /echo HTTP/1.1\r\n\r\n"));
}

TEST_CASE("clients that are refused and stay are no more than their bound") {
  auto limits = for_one_local_client();
  limits.refused = 2;
  limits.grace = patience;
  http_fixture node{limits};
  raw_client first{node.socket_path()};
  first.send("GET /echo HTTP/1.1\r\n\r\n");
  first.read_until("local ");
  std::vector<raw_client> refused;
  for (int i = 0; i < 2; ++i) {
    refused.emplace_back(node.socket_path());
    CHECK(starts_with(refused.back().read_to_end(), "HTTP/1.1 503 "));
  }
  raw_client more{node.socket_path()};
  CHECK(more.read_to_end().empty());
  // Those who go make room for the next one.
  refused.clear();
  std::string reply;
  for (int i = 0; i < 100 && reply.empty(); ++i)
    reply = raw_client{node.socket_path()}.read_to_end();
  CHECK(starts_with(reply, "HTTP/1.1 503 "));
}

TEST_CASE("a shortage of descriptors is waited out") {
  http_fixture node;
  raw_client silent{node.server->port()};
  raw_client spoken{node.server->port()};
  spoken.send(get("/echo"));
  spoken.read_until("tcp ");
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getpeername(spoken.fd(), reinterpret_cast<sockaddr*>(&address), &size);
  {
    const no_descriptors shortage;
    REQUIRE(::connect(fd, reinterpret_cast<sockaddr*>(&address), size) == 0);
    CHECK(node.log.take().find("cannot take connections") != std::string::npos);
    // An unauthenticated peer is given up for whoever comes.
    CHECK(silent.read_to_end().empty());
  }
  const auto request = get("/echo");
  ::send(fd, request.data(), request.size(), MSG_NOSIGNAL);
  std::string buffer(100, '\0');
  CHECK(::recv(fd, buffer.data(), buffer.size(), 0) > 0);
  ::close(fd);
}

} // namespace roscell::test::wire
