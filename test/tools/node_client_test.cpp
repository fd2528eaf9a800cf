#include "tools/roscell/client/node_client.hpp"

#include "actors/edge/http/client/http_call.hpp"
#include "messages/failure.hpp"
#include "test/fake_engine.hpp"
#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

#include <cerrno>
#include <cstdlib>
#include <string>

#include <unistd.h>

using namespace roscell;
using namespace roscell::cli;

TEST_CASE("a node that is not there is unreachable", "[tools]") {
  const node_client nobody{{"/nowhere/node.sock", {}}};
  const auto code_of = [](auto ask) {
    try {
      ask();
      return exit_done;
    } catch (const command_error& e) {
      return e.code;
    }
  };
  CHECK(code_of([&] { nobody.get("/v1/node"); }) == exit_unreachable);
  CHECK(code_of(
            [&] { nobody.post("/v1/requests", "{}", std::chrono::seconds{1}); })
        == exit_unreachable);
  CHECK(code_of([&] {
          nobody.follow("/v1/events", [](std::string_view) { return true; });
        })
        == exit_unreachable);
}

TEST_CASE("a node that ends while it deploys is told of, and the remedy",
          "[tools]") {
  const auto path = "/tmp/roscell-node-client-" + std::to_string(::getpid());
  const test::fake_engine node{
      path, [](test::engine_caller& who, const test::engine_call_seen&) {
        who.hang_up();
      }};
  const node_client client{{path, {}}};
  const auto reported = [&](const std::string& body) {
    try {
      client.post("/v1/requests", body, std::chrono::seconds{10});
      return std::string{};
    } catch (const command_error& e) {
      return std::string{e.what()} + "; " + e.hint;
    }
  };
  CHECK(reported(R"({"type":"task_request","task":"t"})")
        == "the node ended while it deployed; ask again with the same file "
           "once it is back");
  CHECK(reported(R"({"type":"cell_query"})")
        == "the node ended while it worked on the request; ask again once it "
           "is back");
}

TEST_CASE("who has no patience is told at once that a node does not answer",
          "[tools]") {
  const auto path = "/tmp/roscell-node-client-" + std::to_string(::getpid());
  const test::fake_engine node{
      path, [](test::engine_caller&, const test::engine_call_seen&) {}};
  const node_client client{{path, {}}};
  const auto code_of_get = [&] {
    try {
      client.get("/v1/node");
      return exit_done;
    } catch (const command_error& e) {
      return e.code;
    }
  };
  ::setenv("ROSCELL_TIMEOUT", "20ms", 1);
  CHECK(code_of_get() == exit_unreachable);
  ::setenv("ROSCELL_TIMEOUT", "soon", 1);
  CHECK(code_of_get() == exit_usage);
  ::unsetenv("ROSCELL_TIMEOUT");
}

TEST_CASE("a node that another one cannot reach is unreachable, too",
          "[tools]") {
  CHECK(exit_code_of_refusal(error_reply({error_code::unreachable, "gone"}))
        == exit_unreachable);
  CHECK(exit_code_of_refusal(error_reply({error_code::conflict, "no"}))
        == exit_refused);
}

TEST_CASE("an error reply keeps its form", "[tools]") {
  // nlohmann's json makes an array of what stands alone in braces.
  const refused e(json{{"type", "error"}});
  CHECK(e.reply.is_object());
}

TEST_CASE("a socket that may not be opened is no node that is away",
          "[tools]") {
  http_call what;
  what.to.socket_path = "/run/node.sock";
  const http_failure denied{http_failure::kind::no_connection, {}, EACCES};
  const auto why = describe_http_failure(denied, what);
  CHECK(why.code == error_code::unauthorized);
  CHECK(why.message == "may not open '/run/node.sock': Permission denied");
  CHECK(why.hint.empty());
  what.to.socket_path.clear();
  CHECK(describe_http_failure(denied, what).code == error_code::unreachable);
}
