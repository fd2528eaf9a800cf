#include "actors/edge/http/handshake_queue.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"
#include "test/actors/edge/trust/site_people.hpp"

#include <vector>

namespace roscell::test::wire {

namespace {

/// A server of a site, whose answers say who has asked.
struct secure_server {
  explicit secure_server(std::shared_ptr<site_identity> own,
                         http_limits limits = {}) {
    http_server_options options;
    options.port = 0;
    options.identity = std::move(own);
    options.token = bearer;
    options.limits = limits;
    options.handler = [](const http_request& x, const responder& answer) {
      if (x.path == "/large")
        return answer.reply(200, "text/plain", std::string(2'000'000, 'x'));
      if (x.path == "/stream") {
        const auto stream = answer.stream("text/plain");
        stream->write("one\n");
        stream->write("two\n");
        return stream->close();
      }
      answer.reply(200, "text/plain",
                   x.from.substr(0, x.from.find(" at ")) + " " + x.body);
    };
    options.on_distrusted = [this](const std::string&, const distrusted& why) {
      refused.put(to_word(why.why));
    };
    server = expect(http_server::start(io, std::move(options)));
  }

  http_client client(std::shared_ptr<site_identity> as,
                     const std::string& uuid = {}) const {
    return http_client{
        {"", "127.0.0.1", server->port(), bearer, std::move(as), uuid}};
  }

  edge_result<http_reply> ask(std::shared_ptr<site_identity> as,
                              const std::string& uuid = {}) const {
    return client(std::move(as), uuid).request("GET", "/healthz", "", {});
  }

  inbox<std::string> refused;
  io_thread io;
  std::unique_ptr<http_server> server;
};

} // namespace

TEST_CASE("requests by identities arrive, and say who has asked") {
  const site_of_today site;
  secure_server node{site.person(site_role::node, "arm", "ffff")};
  const auto anna = site.person(site_role::operating);
  const auto client = node.client(anna);
  const std::string body(100'000, 'b');
  CHECK(expect(client.request("POST", "/v1/requests", body, {})).body
        == "operator anna " + body);
  CHECK(expect(client.request("GET", "/large", "", {})).body.size()
        == 2'000'000);
  std::vector<std::string> lines;
  (void)expect(client.follow("/stream",
                             [&](std::string_view line) {
                               lines.emplace_back(line);
                               return true;
                             },
                             {}));
  CHECK(lines == std::vector<std::string>{"one", "two"});
}

TEST_CASE("who shows no identity of the site learns nothing") {
  const site_of_today site;
  secure_server node{site.person(site_role::node, "arm", "ffff")};
  SECTION("plain, with the token that counted before") {
    CHECK(std::holds_alternative<edge_error>(node.ask(nullptr)));
    CHECK(node.refused.take() == "no_certificate");
  }
  SECTION("of another site with the same name") {
    const site_of_today other;
    CHECK(std::holds_alternative<edge_error>(
        node.ask(other.person(site_role::operating))));
  }
  SECTION("bytes that are nothing at all, and none") {
    raw_client raw{node.server->port()};
    raw.send("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
    CHECK(raw.read_to_end().find("HTTP") == std::string::npos);
  }
}

TEST_CASE("a client speaks to the node that it means, and to no other") {
  const site_of_today site;
  secure_server node{site.person(site_role::node, "arm", "ffff")};
  const auto anna = site.person(site_role::operating);
  CHECK(expect(node.ask(anna, "ffff")).status == 200);
  const auto other = node.ask(anna, "fffe");
  REQUIRE(std::holds_alternative<edge_error>(other));
  CHECK(std::get<edge_error>(other).code == error_code::unauthorized);
}

TEST_CASE("few shake hands at a time, and fewer of one address") {
  handshake_queue queue{3, 2};
  std::vector<std::string> begun;
  const auto enter = [&](const std::string& from) {
    return queue.enter(from, [&begun, from] { begun.push_back(from); });
  };
  const auto first = enter("a");
  enter("a");
  const auto waiting = enter("a");
  const auto gone = enter("a");
  CHECK(begun.size() == 2);
  enter("b");
  CHECK(begun.back() == "b");
  const auto crowded = enter("c");
  CHECK(begun.size() == 3);
  // Who gives up makes no place, and gets none.
  queue.leave(gone);
  CHECK(begun.size() == 3);
  // In turn: the one who has waited for longest, if his address may.
  queue.leave(first);
  queue.leave(first);
  CHECK(begun.size() == 4);
  CHECK(begun.back() == "a");
  queue.leave(waiting);
  CHECK(begun.back() == "c");
  queue.leave(crowded);
  CHECK(queue.begun() == 2);
}

} // namespace roscell::test::wire
