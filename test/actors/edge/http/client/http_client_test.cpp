#include "test/actors/edge/http/canned_server.hpp"
#include "test/fake_engine.hpp"

#include <atomic>
#include <future>

namespace roscell::test::wire {

namespace {

http_client client_of(const canned_server& server) {
  http_endpoint to;
  to.address = "127.0.0.1";
  to.port = server.port();
  return http_client{to};
}

bool every_line(std::string_view) {
  return true;
}

} // namespace

TEST_CASE("nobody at the other end is unreachable") {
  http_endpoint to;
  to.socket_path = "/tmp/roscell-no-such-socket";
  CHECK(expect_error(http_client{to}.request("GET", "/", {}, {})).code
        == error_code::unreachable);
  to.socket_path.clear();
  to.address = "no-such-host.invalid";
  CHECK(expect_error(http_client{to}.request("GET", "/", {}, {})).code
        == error_code::unreachable);
  to.socket_path = std::string(200, 'x');
  CHECK(expect_error(http_client{to}.request("GET", "/", {}, {})).code
        == error_code::unreachable);
}

TEST_CASE("a server that does not answer is a timeout") {
  const canned_server server{"HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nabc",
                             false};
  http_client::options how;
  how.timeout = 50ms;
  CHECK(expect_error(client_of(server).request("GET", "/", {}, how)).code
        == error_code::timeout);
}

TEST_CASE("a reply that breaks off is unreachable, a strange one too") {
  for (const auto* reply :
       {"", "HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nabc", "SSH-2.0\r\n",
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n"}) {
    const canned_server server{reply};
    INFO(reply);
    CHECK(expect_error(client_of(server).request("GET", "/", {}, {})).code
          == error_code::unreachable);
  }
}

TEST_CASE("a reply without a length ends with its connection") {
  const canned_server server{"HTTP/1.1 404 Not Found\r\n\r\nno such thing"};
  const auto reply = expect(client_of(server).request("GET", "/", {}, {}));
  CHECK(reply.status == 404);
  CHECK(reply.body == "no such thing");
}

TEST_CASE("a stream that breaks without an end is an error") {
  const canned_server server{
      "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nab\n\r\n"};
  std::vector<std::string> lines;
  const auto why =
      expect_error(client_of(server).follow("/",
                                            [&](std::string_view line) {
                                              lines.emplace_back(line);
                                              return true;
                                            },
                                            {}));
  CHECK(why.code == error_code::unreachable);
  CHECK(lines == std::vector<std::string>{"ab"});
}

TEST_CASE("a refusal to stream is a reply like any other") {
  const canned_server server{
      "HTTP/1.1 401 Unauthorized\r\nContent-Length: 4\r\n\r\nno\n\n"};
  const auto reply = expect(client_of(server).follow("/", every_line, {}));
  CHECK(reply.status == 401);
  CHECK(reply.body == "no\n\n");
}

TEST_CASE("a line without an end is given up") {
  const canned_server server{"HTTP/1.1 200 OK\r\n\r\n"
                             + std::string(3'000'000, 'x')};
  CHECK(expect_error(client_of(server).follow("/", every_line, {})).code
        == error_code::unreachable);
}

TEST_CASE("a receiver that has enough lines ends the stream") {
  const canned_server server{"HTTP/1.1 200 OK\r\n\r\n1\n2\n3\n", false};
  int count = 0;
  const auto reply = expect(client_of(server).follow(
      "/", [&](std::string_view) { return ++count < 2; }, {}));
  CHECK(reply.status == 200);
  CHECK(count == 2);
}

TEST_CASE("who waits for a stream can be cancelled from another thread") {
  http_fixture node;
  const http_cancel cancel;
  http_client::options how;
  how.cancel = &cancel;
  edge_result<http_reply> result;
  std::thread reader{
      [&] { result = node.tcp_client().follow("/follow", every_line, how); }};
  const auto stream = node.requests.take().answer.stream(event_stream_content);
  stream->write("data: 1\n\n");
  cancel.cancel();
  reader.join();
  CHECK(expect_error(result).message == "cancelled");
}

TEST_CASE("a server that is stopped is not waited for") {
  // The kernel goes on to accept connections for it.
  const canned_server server{"", false};
  http_client::options how;
  how.timeout = 1h;
  how.proof = {"/healthz", 20ms, 50ms};
  const auto why = expect_error(client_of(server).request("GET", "/", {}, how));
  CHECK(why.code == error_code::unreachable);
  CHECK_THAT(why.message, Catch::Contains(client_of(server).endpoint().name()));
  CHECK_THAT(why.hint, Catch::Contains("kill -CONT"));
}

TEST_CASE("a stream whose server is stopped ends") {
  const canned_server server{"HTTP/1.1 200 OK\r\n\r\n1\n", false};
  http_client::options how;
  how.proof = {"/healthz", 20ms, 50ms};
  int count = 0;
  const auto count_lines = [&](std::string_view) { return ++count > 0; };
  CHECK(expect_error(client_of(server).follow("/", count_lines, how)).code
        == error_code::unreachable);
  CHECK(count == 1);
}

TEST_CASE("a server that works for long and says so meanwhile is waited "
          "for") {
  const auto path = "/tmp/roscell-proof-of-life-" + std::to_string(::getpid());
  constexpr int answers_meanwhile = 3;
  std::promise<void> asked_often;
  std::atomic<int> answers{0};
  const fake_engine server{
      path, [&](engine_caller& who, const engine_call_seen& what) {
        if (what.target == "/long")
          asked_often.get_future().wait();
        else if (++answers == answers_meanwhile)
          asked_often.set_value();
        who.reply(200, what.target);
      }};
  http_endpoint to;
  to.socket_path = path;
  http_client::options how;
  how.proof = {"/healthz", 10ms, 10s};
  CHECK(expect(http_client{to}.request("GET", "/long", {}, how)).body
        == "/long");
}

TEST_CASE("a path that would break the request is not sent") {
  http_fixture node;
  for (const auto* path : {"/a b", "/a\r\nX: y", "/\x7f"})
    CHECK(expect_error(node.tcp_client().request("GET", path, {}, {})).code
          == error_code::schema_violation);
}

TEST_CASE("headers of the caller are sent along") {
  http_fixture node;
  http_client::options how;
  how.headers["Expect"] = "100-continue";
  const auto reply =
      expect(node.local_client().request("POST", "/echo", "body", how));
  CHECK(reply.status == 200);
  CHECK(reply.body == "POST /echo local body");
}

} // namespace roscell::test::wire
