#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/http/limits.hpp"
#include "test/actors/edge/http/canned_server.hpp"

namespace roscell::test::wire {

namespace {

using answer = edge_result<http_reply>;

http_call call_to(uint16_t port, std::string path = "/") {
  http_call result;
  result.to.address = "127.0.0.1";
  result.to.port = port;
  result.target = std::move(path);
  return result;
}

answer ask(io_thread& io, const http_call& what) {
  inbox<answer> answers;
  call_http(io.core(), what, [&](http_outcome x) {
    answers.put(to_edge_result(std::move(x), what));
  });
  return answers.take();
}

edge_error refusal_of(const http_call& what) {
  io_thread io;
  return expect_error(ask(io, what));
}

/// A port on which nobody listens.
uint16_t closed_port() {
  const canned_server once{""};
  raw_client{once.port()}.close();
  return once.port();
}

} // namespace

TEST_CASE("an exchange carries method, path and body, and brings the reply") {
  http_fixture node;
  auto call = call_to(node.server->port(), "/healthz?a=b%20c");
  CHECK(expect(ask(node.io, call)).body == "GET /healthz a=b c tcp ");
  call.method = "POST";
  call.body = R"({"type":"registration_switch"})";
  const auto reply = expect(ask(node.io, call));
  CHECK(reply.status == 200);
  CHECK(reply.content_type == "text/plain");
  CHECK(reply.body == "POST /healthz a=b c tcp " + call.body);
}

TEST_CASE("a refusal is a reply of an exchange like any other") {
  http_fixture node;
  const auto reply =
      expect(ask(node.io, call_to(node.server->port(), "/v1/cell")));
  CHECK(reply.status == 401);
  CHECK(reply.body.find("unauthorized") != std::string::npos);
}

TEST_CASE("an exchange with nobody is unreachable at once") {
  const auto why = refusal_of(call_to(closed_port()));
  CHECK(why.code == error_code::unreachable);
  CHECK(why.message.find("cannot connect to 127.0.0.1:") == 0);
}

TEST_CASE("an exchange with a silent peer ends in time") {
  for (const auto* begun : {"", "HTTP/1.1 200 OK\r\n",
                            "HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\nab"}) {
    const canned_server silent{begun, false};
    auto call = call_to(silent.port());
    call.timeout = 50ms;
    const auto why = refusal_of(call);
    CHECK(why.code == error_code::timeout);
    CHECK(why.message.find("within 50 ms") != std::string::npos);
  }
}

TEST_CASE("an exchange takes a reply up to its limit, and no longer one") {
  const auto head = [](size_t size) {
    return "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(size)
           + "\r\n\r\n";
  };
  {
    const canned_server full{head(limits::http::exchanged_bytes)
                             + std::string(limits::http::exchanged_bytes, 'x')};
    io_thread io;
    CHECK(expect(ask(io, call_to(full.port()))).body.size()
          == limits::http::exchanged_bytes);
  }
  const auto long_body = std::string(limits::http::exchanged_bytes + 1, 'x');
  for (const auto& reply :
       {head(limits::http::exchanged_bytes + 1),
        "HTTP/1.1 200 OK\r\n\r\n" + long_body,
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n10001\r\n"
            + long_body}) {
    const canned_server server{reply, false};
    const auto why = refusal_of(call_to(server.port()));
    CHECK(why.code == error_code::unreachable);
    CHECK(why.message.find("longer than 65536 bytes") != std::string::npos);
  }
}

TEST_CASE("an exchange survives what is no reply") {
  for (const auto& reply :
       {std::string{}, std::string{"SSH-2.0\r\n"}, std::string(9000, 'h'),
        std::string{"HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nabc"},
        std::string{"HTTP/1.1 200 OK\r\nContent-Length: -1\r\n\r\n"},
        "HTTP/1.1 200 OK\r\nX: " + std::string(9000, 'h') + "\r\n\r\n",
        std::string{"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n"
                    "3\r\nabc\r\n"},
        std::string{"\0\xff\x01\n\n\n", 6}}) {
    const canned_server server{reply};
    INFO(reply);
    CHECK(refusal_of(call_to(server.port())).code == error_code::unreachable);
  }
}

TEST_CASE("a reply without a length ends with the exchange's connection") {
  const canned_server server{"HTTP/1.1 404 Not Found\r\n\r\nno such thing"};
  io_thread io;
  const auto reply = expect(ask(io, call_to(server.port())));
  CHECK(reply.status == 404);
  CHECK(reply.body == "no such thing");
}

TEST_CASE("an exchange that cannot be is refused") {
  for (const auto* path : {"", "x", "/a b", "/a\r\nX: y", "/%zz"})
    CHECK(refusal_of(call_to(1, path)).code == error_code::schema_violation);
  auto call = call_to(0);
  CHECK(refusal_of(call).code == error_code::schema_violation);
  call.to.port = 1;
  for (const auto* address : {"", "localhost", "::1", "1.2.3"}) {
    call.to.address = address;
    CHECK(refusal_of(call).code == error_code::schema_violation);
  }
}

TEST_CASE("the end of the io thread ends an exchange, once") {
  const canned_server silent{"", false};
  inbox<http_failure::kind> answers;
  const auto keep = [&](const http_outcome& x) {
    answers.put(std::get<http_failure>(x).what);
  };
  {
    io_thread io;
    call_http(io.core(), call_to(silent.port()), keep);
    settle(io);
    io.stop();
    CHECK(answers.take() == http_failure::kind::stopped);
    call_http(io.core(), call_to(silent.port()), keep);
    CHECK(answers.take() == http_failure::kind::stopped);
  }
  CHECK(answers.size() == 0);
}

TEST_CASE("an exchange whose callback throws does no harm") {
  http_fixture node;
  const auto call = call_to(node.server->port(), "/healthz");
  call_http(node.io.core(), call, [](const http_outcome&) { throw 1; });
  CHECK(node.log.take().find("threw") != std::string::npos);
  CHECK(expect(ask(node.io, call)).status == 200);
}

} // namespace roscell::test::wire
