#include "test/actors/edge/io/edge_fixture.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <thread>

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace roscell::test::wire {

namespace {

http_reply ask(const http_client& client, const std::string& path,
               const std::string& method = "GET", const std::string& body = {},
               const http_client::options& how = {}) {
  return expect(client.request(method, path, body, how));
}

std::string code_of(const std::string& body) {
  const auto json = nlohmann::json::parse(body);
  CHECK(json.at("type") == "error");
  const auto& error = json.at("error");
  CHECK(error.at("message").get<std::string>() != "");
  CHECK(error.count("where") == 1);
  CHECK(error.count("hint") == 1);
  return error.at("code");
}

/// The body of a raw reply.
std::string body_of(const std::string& reply) {
  return reply.substr(reply.find("\r\n\r\n") + 4);
}

} // namespace

TEST_CASE("a request arrives with its parts decoded, by TCP and by socket") {
  http_fixture node;
  const auto remote = ask(node.tcp_client(), "/echo?a=1&b=x%20y+z&c", "POST",
                          R"({"type":"cell_query"})");
  CHECK(remote.status == 200);
  CHECK(remote.content_type == "text/plain");
  CHECK(remote.body
        == R"(POST /echo a=1 b=x y z c= tcp {"type":"cell_query"})");
  CHECK(ask(node.local_client(), "/%65cho").body == "GET /echo local ");
}

TEST_CASE("TCP needs the bearer token but for public paths") {
  http_fixture node;
  for (const auto* token :
       {"", "wrong", "the-bearer-toke", "the-bearer-token2"}) {
    const auto reply = ask(node.tcp_client(token), "/echo");
    CHECK(reply.status == 401);
    CHECK(code_of(reply.body) == "unauthorized");
    CHECK(ask(node.tcp_client(token), "/healthz").status == 200);
  }
  CHECK(ask(node.tcp_client(), "/echo").status == 200);
  CHECK(node.requests.size() == 0);
}

TEST_CASE("a permit is for reading, of what it names, by whom it names") {
  io_thread io;
  http_server_options options;
  options.port = 0;
  options.token = "the-bearer-token";
  options.handler = [](const http_request&, const responder& answer) {
    answer.reply(200, "text/plain", "read");
  };
  options.permits = [](const std::string& path, std::string_view token,
                       const std::string& from) {
    return path == "/allowed" && token == "permit" && from == "127.0.0.1";
  };
  const auto server = expect(http_server::start(io, options));
  const auto status = [&](const std::string& what, const std::string& token) {
    raw_client client{server->port()};
    client.send(what + " HTTP/1.1\r\nAuthorization: Bearer " + token
                + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    return client.read_to_end().substr(0, 12);
  };
  CHECK(status("GET /allowed", "permit") == "HTTP/1.1 200");
  CHECK(status("GET /allowed", "permi") == "HTTP/1.1 401");
  CHECK(status("GET /allowed/more", "permit") == "HTTP/1.1 401");
  CHECK(status("POST /allowed", "permit") == "HTTP/1.1 401");
  CHECK(status("GET /other", "permit") == "HTTP/1.1 401");
  CHECK(status("GET /other", "the-bearer-token") == "HTTP/1.1 200");
}

TEST_CASE("a server without a token lets nobody in by TCP") {
  io_thread io;
  http_server_options options;
  options.port = 0;
  options.handler = [](const http_request&, const responder&) {};
  const auto server = expect(http_server::start(io, options));
  raw_client client{server->port()};
  client.send("GET / HTTP/1.1\r\nAuthorization: Bearer \r\n\r\n");
  CHECK(client.read_to_end().find("401") != std::string::npos);
}

namespace {

/// "name=value", as a server has set it.
std::string cookie_in(const std::string& reply) {
  const std::string name = "\r\nSet-Cookie: ";
  const auto begin = reply.find(name) + name.size();
  return reply.substr(begin, reply.find(';', begin) - begin);
}

/// A server for a browser: nobody has a token, but some know a path.
struct browsed_server {
  io_thread io;
  std::unique_ptr<http_server> server;

  browsed_server() {
    http_server_options options;
    options.port = 0;
    options.path_secret = "s3cret";
    options.hosts = {"127.0.0.1", "localhost"};
    options.handler = [](const http_request& request, const responder& answer) {
      answer.reply(200, "text/html", request.path);
    };
    server = expect(http_server::start(io, options));
  }

  std::string get(const std::string& path, const std::string& host) const {
    return ask("GET " + path, host, "");
  }

  /// @param more lines of the header.
  std::string ask(const std::string& what, const std::string& host,
                  const std::string& more) const {
    raw_client client{server->port()};
    client.send(what + " HTTP/1.1\r\nHost: " + host + "\r\n" + more
                + "Connection: close\r\n\r\n");
    return client.read_to_end();
  }

  /// The line of a header, for whoever has followed the link.
  std::string cookie() const {
    return "Cookie: " + cookie_in(get("/s3cret/page", "127.0.0.1")) + "\r\n";
  }
};

bool has_status(const std::string& reply, const std::string& status) {
  return reply.find("HTTP/1.1 " + status + " ") == 0;
}

} // namespace

TEST_CASE("a link is good once, for a cookie that counts from then on") {
  const browsed_server x;
  for (const auto* path : {"/page", "/", "/s3cret", "/s3crets/page",
                           "/s3cre/page", "//s3cret/page", "/wrong1/page"})
    CHECK(has_status(x.get(path, "127.0.0.1"), "401"));
  const auto reply = x.get("/s3cret/page", "127.0.0.1:80");
  CHECK(has_status(reply, "303"));
  CHECK(reply.find("\r\nLocation: /page\r\n") != std::string::npos);
  CHECK(reply.find("; Path=/; HttpOnly; SameSite=Strict\r\n")
        != std::string::npos);
  const auto cookie = "Cookie: other=1; " + cookie_in(reply) + "\r\n";
  const auto page = x.ask("GET /page", "127.0.0.1:80", cookie);
  CHECK(has_status(page, "200"));
  CHECK(body_of(page) == "/page");
  // Nobody else comes in by the link, and he who has the cookie still does.
  CHECK(has_status(x.get("/s3cret/page", "127.0.0.1"), "401"));
  CHECK(has_status(x.ask("GET /s3cret/page", "127.0.0.1", cookie), "303"));
  CHECK(has_status(x.ask("GET /page", "127.0.0.1", "Cookie: roscell=\r\n"),
                   "401"));
}

TEST_CASE("a link leads nowhere else") {
  const browsed_server x;
  const auto reply = x.get("/s3cret//evil.example/page", "127.0.0.1:80");
  CHECK(has_status(reply, "303"));
  CHECK(reply.find("\r\nLocation: /\r\n") != std::string::npos);
}

TEST_CASE("a name that leads here by chance is refused") {
  const browsed_server x;
  for (const auto* host : {"evil.example", "127.0.0.1.evil.example", ""})
    CHECK(has_status(x.get("/s3cret/page", host), "403"));
  CHECK(has_status(x.get("/s3cret/page", "localhost"), "303"));
}

TEST_CASE("a page from elsewhere has nothing done by the cookie") {
  const browsed_server x;
  const auto cookie = x.cookie();
  const auto status_of = [&](const std::string& method,
                             const std::string& more) {
    return x.ask(method + " /v1/requests", "127.0.0.1:80", cookie + more)
        .substr(9, 3);
  };
  for (const auto* more :
       {"", "Origin: http://127.0.0.1:80\r\n",
        "Sec-Fetch-Site: same-origin\r\n",
        "Origin: http://127.0.0.1:80\r\nSec-Fetch-Site: same-origin\r\n"})
    CHECK(status_of("POST", more) == "200");
  for (const auto* more :
       {"Origin: http://evil.example\r\n", "Origin: null\r\n",
        "Origin: http://127.0.0.1:81\r\n", "Origin: http://localhost:80\r\n",
        "Origin: https://127.0.0.1:80\r\n", "Sec-Fetch-Site: cross-site\r\n"})
    CHECK(status_of("POST", more) == "403");
  CHECK(status_of("GET", "Origin: http://evil.example\r\n") == "403");
}

TEST_CASE("a link or a file may lead a browser to the link") {
  const browsed_server x;
  CHECK(has_status(x.ask("GET /s3cret/page", "127.0.0.1",
                         "Sec-Fetch-Site: cross-site\r\n"
                         "Sec-Fetch-Mode: navigate\r\n"),
                   "303"));
}

TEST_CASE("a page may load nothing from elsewhere, nor be shown there") {
  const browsed_server x;
  const auto reply = x.ask("GET /page", "127.0.0.1", x.cookie());
  CHECK(reply.find("Content-Security-Policy: default-src 'none'; ")
        != std::string::npos);
  CHECK(reply.find("frame-ancestors 'none'") != std::string::npos);
}

TEST_CASE("methods other than GET and POST are refused") {
  http_fixture node;
  for (const auto* method : {"OPTIONS", "DELETE", "PUT", "BREW"}) {
    const auto reply = ask(node.tcp_client(), "/echo", method);
    CHECK(reply.status == 405);
    CHECK(code_of(reply.body) == "unknown_type");
  }
  raw_client client{node.server->port()};
  client.send("HEAD /echo HTTP/1.1\r\nHost: x\r\n\r\n");
  const auto reply = client.read_to_end();
  CHECK(reply.find("HTTP/1.1 405 Method Not Allowed\r\n") == 0);
  CHECK(reply.find("Allow: GET, POST") != std::string::npos);
  CHECK(body_of(reply).empty());
}

TEST_CASE("what is no HTTP gets status 400") {
  http_fixture node;
  for (const auto* text :
       {"\r\n\r\n\r\n", "hello\r\n\r\n", "GET echo HTTP/1.1\r\n\r\n",
        "GET /%zz HTTP/1.1\r\n\r\n", "GET /%00 HTTP/1.1\r\n\r\n",
        "POST /echo HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
        "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n"
        "Content-Length: 3\r\n\r\nabc"}) {
    raw_client client{node.socket_path()};
    client.send(text);
    const auto reply = client.read_to_end();
    INFO(text << " -> " << reply);
    CHECK(reply.find("HTTP/1.1 400 Bad Request\r\n") == 0);
    CHECK(code_of(body_of(reply)) == "schema_violation");
  }
}

TEST_CASE("a connection carries one request after the other") {
  http_fixture node;
  raw_client client{node.server->port()};
  for (int i = 0; i < 3; ++i) {
    client.send(get("/echo?n=" + std::to_string(i)));
    const auto reply = client.read_until("tcp ");
    CHECK(reply.find("Connection: keep-alive") != std::string::npos);
    CHECK(body_of(reply) == "GET /echo n=" + std::to_string(i) + " tcp ");
  }
}

TEST_CASE("requests sent at once are answered in order") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/echo?n=1") + get("/echo?n=2")
              + get("/echo?n=3", "Connection: close\r\n"));
  const auto replies = client.read_to_end();
  const auto first = replies.find("n=1");
  const auto second = replies.find("n=2");
  const auto third = replies.find("n=3");
  CHECK(first < second);
  CHECK(second < third);
  CHECK(third != std::string::npos);
}

TEST_CASE("a body may come in pieces and in chunks") {
  http_fixture node;
  raw_client client{node.socket_path()};
  client.send("POST /echo HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n3\r");
  client.send("\nabc\r\n4;x=y\r\nde");
  client.send("fg\r\n0\r\n\r\n");
  CHECK(body_of(client.read_until("g")) == "POST /echo local abcdefg");
  client.send("POST /echo HTTP/1.1\r\nContent-Length: 4\r\n\r\n12");
  client.send("34");
  CHECK(body_of(client.read_until("34")) == "POST /echo local 1234");
}

TEST_CASE("a client that waits for 100 Continue gets it") {
  http_fixture node;
  raw_client client{node.socket_path()};
  client.send("POST /echo HTTP/1.1\r\nExpect: 100-continue\r\n"
              "Content-Length: 2\r\n\r\n");
  CHECK(client.read_until("\r\n\r\n") == "HTTP/1.1 100 Continue\r\n\r\n");
  client.send("ok");
  CHECK(body_of(client.read_until("ok")) == "POST /echo local ok");
}

TEST_CASE("a request that is dropped or makes its handler throw gets 500") {
  http_fixture node;
  std::thread dropper{[&] { node.requests.take(); }};
  const auto reply = ask(node.local_client(), "/drop");
  dropper.join();
  CHECK(reply.status == 500);
  CHECK(code_of(reply.body) == "internal");

  http_server_options options;
  options.port = 0;
  options.token = bearer;
  options.handler = [](const http_request&, const responder&) {
    throw std::runtime_error("handler broke");
  };
  const auto server = expect(http_server::start(node.io, options));
  raw_client client{server->port()};
  client.send(get("/"));
  CHECK(client.read_until("\"error\"}").find(" 500 ") != std::string::npos);
  CHECK(node.log.take().find("handler broke") != std::string::npos);
}

TEST_CASE("the first answer counts") {
  http_fixture node;
  bool third_written = true;
  std::thread answerer{[&] {
    const auto asked = node.requests.take();
    asked.answer.reply(201, "text/plain", "first");
    asked.answer.reply(202, "text/plain", "second");
    third_written = asked.answer.stream("text/plain")->write("third");
  }};
  const auto reply = ask(node.local_client(), "/x");
  answerer.join();
  CHECK(reply.status == 201);
  CHECK(reply.body == "first");
  CHECK_FALSE(third_written);
}

TEST_CASE("a client that leaves before its answer does no harm") {
  http_fixture node;
  for (int i = 0; i < 10; ++i) {
    raw_client client{node.server->port()};
    client.send(get("/slow"));
    const auto asked = node.requests.take();
    client.close();
    settle(node.io);
    asked.answer.reply(200, "text/plain", std::string(100'000, 'x'));
  }
  CHECK(ask(node.tcp_client(), "/echo").status == 200);
}

TEST_CASE("a client that has closed its sending side still gets its answer") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/half"));
  const auto asked = node.requests.take();
  ::shutdown(client.fd(), SHUT_WR);
  asked.answer.reply(200, "text/plain", "late");
  CHECK(body_of(client.read_to_end()) == "late");
}

TEST_CASE("a port in use is a conflict, an address of another host is wrong") {
  http_fixture node;
  http_server_options options;
  options.port = node.server->port();
  const auto why = expect_error(http_server::start(node.io, options));
  CHECK(why.code == error_code::conflict);
  CHECK(why.message.find("is in use") != std::string::npos);
  for (const auto* address : {"192.0.2.1", "localhost", "::1"}) {
    options.address = address;
    const auto wrong = expect_error(http_server::start(node.io, options));
    CHECK(wrong.code == error_code::schema_violation);
  }
}

TEST_CASE("the Unix socket of a living node is not taken, a dead one's is") {
  http_fixture node;
  http_server_options options;
  options.port = 0;
  options.socket_path = node.socket_path();
  const auto why = expect_error(http_server::start(node.io, options));
  CHECK(why.code == error_code::conflict);
  CHECK(why.message.find("another node runs here") != std::string::npos);
  CHECK(ask(node.local_client(), "/echo").status == 200);

  // A copy of the directory entry is what a killed process leaves behind.
  const auto stale = node.folder / "stale.sock";
  ::rename(node.socket_path().c_str(), stale.c_str());
  inbox<bool> stopped;
  node.server->stop([&] { stopped.put(true); });
  stopped.take();
  options.socket_path = stale;
  const auto heir = expect(http_server::start(node.io, options));
  struct stat made {};
  REQUIRE(::stat(stale.c_str(), &made) == 0);
  CHECK((made.st_mode & 0777) == 0660);
}

TEST_CASE("a file that is no socket is left alone") {
  http_fixture node;
  http_server_options options;
  options.port = 0;
  options.socket_path = node.folder / "precious";
  std::ofstream{options.socket_path} << "data";
  CHECK(expect_error(http_server::start(node.io, options)).code
        == error_code::conflict);
  CHECK(std::ifstream{options.socket_path}.good());
  options.socket_path = node.folder / std::string(120, 'x');
  CHECK(expect_error(http_server::start(node.io, options)).code
        == error_code::schema_violation);
  options.socket_path = node.folder / "no/such/folder";
  CHECK(expect_error(http_server::start(node.io, options)).code
        == error_code::internal);
}

TEST_CASE("a server that stops finishes what it works on and takes no more") {
  http_fixture node;
  raw_client idle{node.server->port()};
  raw_client busy{node.server->port()};
  busy.send(get("/work"));
  const auto asked = node.requests.take();
  inbox<bool> stopped;
  node.server->stop([&] { stopped.put(true); });
  CHECK(::access(node.socket_path().c_str(), F_OK) != 0);
  CHECK(idle.read_to_end().empty());
  asked.answer.reply(200, "text/plain", "done");
  const auto reply = busy.read_to_end();
  CHECK(body_of(reply) == "done");
  CHECK(reply.find("Connection: close") != std::string::npos);
  busy.close();
  stopped.take();
  CHECK(expect_error(node.tcp_client().request("GET", "/echo", {}, {})).code
        == error_code::unreachable);
  CHECK(expect_error(node.local_client().request("GET", "/echo", {}, {})).code
        == error_code::unreachable);
}

TEST_CASE(
    "a request that does not end does not keep the server from stopping") {
  http_limits limits;
  limits.grace = 50ms;
  http_fixture node{limits};
  raw_client busy{node.server->port()};
  busy.send(get("/work"));
  const auto asked = node.requests.take();
  inbox<bool> stopped;
  node.server->stop([&] { stopped.put(true); });
  stopped.take();
  CHECK(busy.read_to_end().empty());
  asked.answer.reply(200, "text/plain", "too late");
}

TEST_CASE("the end of the io thread ends the server") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/work"));
  const auto asked = node.requests.take();
  node.io.stop();
  CHECK(client.read_to_end().empty());
  asked.answer.reply(200, "text/plain", "too late");
  node.server->stop([] { FAIL("called after the end"); });
}

} // namespace roscell::test::wire
