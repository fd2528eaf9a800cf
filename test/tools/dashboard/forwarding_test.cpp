#include "tools/roscell/dashboard/pages.hpp"

#include "actors/edge/http/client/http_client.hpp"
#include "actors/edge/http/http_server.hpp"

#include <catch2/catch.hpp>

#include <future>
#include <variant>

namespace roscell::cli {

namespace {

std::unique_ptr<http_server> serve(io_thread& io, http_handler handler) {
  http_server_options options;
  options.port = 0;
  options.token = "node-token";
  options.handler = std::move(handler);
  return std::get<std::unique_ptr<http_server>>(
      http_server::start(io, std::move(options)));
}

/// A node that says what it was asked, and what a browser sees of it.
struct bench {
  io_thread io;
  std::shared_ptr<http_stream> events;
  std::unique_ptr<http_server> node;
  std::unique_ptr<http_server> front;
  const web_pages pages{{"/dashboard/", {"text/html", "the page"}}};

  bench() {
    node =
        serve(io, [this](const http_request& request, const responder& answer) {
          if (request.path == "/v1/events") {
            events = answer.stream(event_stream_content);
            events->write("data: 1\n\n");
            return;
          }
          std::string text = request.method + " " + request.path;
          for (const auto& [key, value] : request.query)
            text += " " + key + "=" + value;
          answer.reply(request.path == "/v1/gone" ? 404 : 200, json_content,
                       text + " " + request.body);
        });
    front =
        serve(io, make_forwarding(io.core(),
                                  {"", "127.0.0.1", node->port(), "node-token"},
                                  pages));
  }

  http_client browser() const {
    return http_client{{"", "127.0.0.1", front->port(), "node-token"}};
  }

  http_reply ask(const std::string& path, const std::string& method = "GET",
                 const std::string& body = {}) const {
    return std::get<http_reply>(browser().request(method, path, body, {}));
  }
};

} // namespace

TEST_CASE("a page of the dashboard is shown as it is", "[dashboard]") {
  const bench x;
  const auto reply = x.ask("/dashboard/");
  CHECK(reply.status == 200);
  CHECK(reply.content_type == "text/html");
  CHECK(reply.body == "the page");
}

TEST_CASE("what a page asks goes to the node, and its answer back",
          "[dashboard]") {
  const bench x;
  CHECK(x.ask("/v1/tasks/a%20b?follow=0&x=1%262").body
        == "GET /v1/tasks/a b follow=0 x=1&2 ");
  CHECK(x.ask("/v1/requests", "POST", "{}").body == "POST /v1/requests {}");
  CHECK(x.ask("/v1/gone").status == 404);
}

TEST_CASE("nothing else of the node is reached through it", "[dashboard]") {
  const bench x;
  CHECK(x.ask("/healthz").status == 404);
  CHECK(x.ask("/dashboard/nothing.js").status == 404);
}

TEST_CASE("a node that does not answer is said to be out of reach",
          "[dashboard]") {
  bench x;
  x.node.reset();
  const auto reply = x.ask("/v1/cell");
  CHECK(reply.status == 502);
  CHECK(reply.body.find("unreachable") != std::string::npos);
}

TEST_CASE("a stream is passed on as it comes, and ends with the browser",
          "[dashboard]") {
  bench x;
  std::promise<void> ended;
  std::string line;
  const auto reply =
      x.browser().follow("/v1/events",
                         [&](std::string_view text) {
                           line = text;
                           x.events->on_closed([&ended] { ended.set_value(); });
                           return false;
                         },
                         {});
  CHECK(line == "data: 1");
  CHECK(ended.get_future().wait_for(std::chrono::seconds{30})
        == std::future_status::ready);
}

TEST_CASE("a browser sees whether a stream has ended or was broken off",
          "[dashboard]") {
  bench x;
  const auto follow_until = [&](auto end) {
    return x.browser().follow("/v1/events",
                              [&](std::string_view line) {
                                if (line == "data: 1")
                                  end();
                                return true;
                              },
                              {});
  };
  CHECK(std::holds_alternative<http_reply>(
      follow_until([&] { x.events->close(); })));
  CHECK(std::holds_alternative<edge_error>(
      follow_until([&] { x.node.reset(); })));
}

TEST_CASE("the dashboard is one page and what it loads", "[dashboard]") {
  const auto& pages = dashboard_pages();
  REQUIRE(pages.count("/dashboard/") == 1);
  // Without the slash a browser is sent there, below whatever secret it used.
  REQUIRE(pages.count("/dashboard") == 1);
  CHECK(pages.at("/dashboard").body.find("url=dashboard/")
        != std::string_view::npos);
  size_t bytes = 0;
  for (const auto& [path, page] : pages) {
    CHECK_FALSE(page.content_type.empty());
    bytes += page.body.size();
  }
  CHECK(bytes < 200 * 1024);
}

} // namespace roscell::cli
