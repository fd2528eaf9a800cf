#include "test/actors/edge/io/edge_fixture.hpp"

#include <thread>

namespace roscell::test::wire {

namespace {

/// A reply to `/follow` that the test writes, and its end.
struct open_stream {
  explicit open_stream(http_fixture& node,
                       const std::string& type = event_stream_content)
      : stream(node.requests.take().answer.stream(type)) {
    stream->on_closed([this] { closed.put(true); });
  }

  inbox<bool> closed;
  std::shared_ptr<http_stream> stream;
};

/// Writes until the stream takes no more.
void flood(http_stream& stream) {
  const std::string chunk(64 * 1024, 'x');
  while (stream.write(chunk)) {
    // The io thread may take some of it away in between.
  }
}

} // namespace

TEST_CASE("the lines of a stream arrive in order until its end") {
  http_fixture node;
  std::vector<std::string> lines;
  std::thread reader{[&] {
    const auto reply =
        expect(node.tcp_client().follow("/follow?since=3",
                                        [&](std::string_view line) {
                                          lines.emplace_back(line);
                                          return true;
                                        },
                                        {}));
    lines.push_back(std::to_string(reply.status) + reply.content_type);
  }};
  open_stream events{node};
  for (int i = 0; i < 3; ++i)
    CHECK(events.stream->write("data: " + std::to_string(i) + "\n\n"));
  CHECK(events.stream->write("da"));
  CHECK(events.stream->write("ta: last\r\nrest"));
  events.stream->close();
  reader.join();
  CHECK(lines
        == std::vector<std::string>{"data: 0", "", "data: 1", "", "data: 2", "",
                                    "data: last", "rest",
                                    "200text/event-stream"});
  CHECK(events.closed.take());
  CHECK_FALSE(events.stream->write("more"));
}

TEST_CASE("a stream that its owner lets go of ends properly") {
  http_fixture node;
  raw_client client{node.socket_path()};
  client.send("GET /follow HTTP/1.1\r\n\r\n");
  node.requests.take().answer.stream("text/plain")->write("only line\n");
  const auto reply = client.read_to_end();
  CHECK(reply.find("Transfer-Encoding: chunked") != std::string::npos);
  CHECK(reply.find("\r\n\r\na\r\nonly line\n\r\n0\r\n\r\n")
        != std::string::npos);
}

TEST_CASE("a stream that is broken off has no proper end") {
  http_fixture node;
  raw_client client{node.socket_path()};
  client.send("GET /follow HTTP/1.1\r\n\r\n");
  const auto stream = node.requests.take().answer.stream("text/plain");
  stream->write("only line\n");
  stream->break_off();
  const auto reply = client.read_to_end();
  CHECK(reply.find("a\r\nonly line\n\r\n") == reply.size() - 15);
  CHECK_FALSE(stream->write("more"));
}

TEST_CASE("a client of HTTP/1.0 gets a stream without chunks") {
  http_fixture node;
  raw_client client{node.socket_path()};
  client.send("GET /follow HTTP/1.0\r\n\r\n");
  node.requests.take().answer.stream("text/plain")->write("line\n");
  const auto reply = client.read_to_end();
  CHECK(reply.find("chunked") == std::string::npos);
  CHECK(reply.find("\r\n\r\nline\n") == reply.size() - 9);
}

TEST_CASE("the owner of a stream hears once that its reader has gone") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/follow"));
  open_stream events{node};
  events.stream->write("data: 1\n\n");
  client.read_until("data: 1");
  client.close();
  CHECK(events.closed.take());
  events.stream->close();
  settle(node.io);
  CHECK(events.closed.size() == 0);
  CHECK_FALSE(events.stream->write("data: 2\n\n"));
  inbox<bool> late;
  events.stream->on_closed([&] { late.put(true); });
  CHECK(late.take());
}

TEST_CASE("a stream to a client that left before it began is over at once") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/follow"));
  const auto asked = node.requests.take();
  client.close();
  const auto stream = asked.answer.stream(event_stream_content);
  inbox<bool> closed;
  stream->on_closed([&] { closed.put(true); });
  stream->write("data: 1\n\n");
  CHECK(closed.take());
}

TEST_CASE("a reader that is too slow is cut off and told why") {
  http_fixture node;
  raw_client client{node.server->port(), 4096};
  client.send(get("/follow"));
  open_stream events{node};
  flood(*events.stream);
  const auto reply = client.read_to_end();
  CHECK(reply.find("event: error\ndata: ") != std::string::npos);
  CHECK(reply.find("its reader is too slow") != std::string::npos);
  CHECK(reply.find("\r\n0\r\n\r\n") == std::string::npos);
  CHECK(reply.size() < 8 * http_limits{}.stream_bytes);
  client.close();
  CHECK(events.closed.take());
}

TEST_CASE("a reader that reads nothing at all does not hold the stream") {
  http_limits limits;
  limits.write = limits.grace = 50ms;
  http_fixture node{limits};
  raw_client client{node.server->port(), 4096};
  client.send(get("/follow"));
  open_stream events{node};
  flood(*events.stream);
  CHECK(events.closed.take());
}

TEST_CASE("a client that talks during its stream is tolerated for a while") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/follow"));
  open_stream events{node};
  client.send("hello?");
  settle(node.io);
  CHECK(events.stream->write("data: 1\n\n"));
  client.read_until("data: 1");
  client.send(std::string(200'000, 'x'));
  CHECK(events.closed.take());
}

TEST_CASE("streams end when the server stops") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/follow"));
  open_stream events{node};
  events.stream->write("data: 1\n\n");
  inbox<bool> stopped;
  node.server->stop([&] { stopped.put(true); });
  const auto reply = client.read_to_end();
  CHECK(reply.find("data: 1") != std::string::npos);
  CHECK(reply.find("\r\n0\r\n\r\n") != std::string::npos);
  client.close();
  stopped.take();
  CHECK(events.closed.take());
}

TEST_CASE("streams end with the io thread") {
  http_fixture node;
  raw_client client{node.server->port()};
  client.send(get("/follow"));
  open_stream events{node};
  settle(node.io);
  node.io.stop();
  CHECK(events.closed.take());
  CHECK(client.read_to_end().find("\r\n0\r\n\r\n") == std::string::npos);
}

} // namespace roscell::test::wire
