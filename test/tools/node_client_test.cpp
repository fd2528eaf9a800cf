#include "tools/roscell/client/node_client.hpp"

#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

TEST_CASE("an id becomes one segment of a path", "[tools]") {
  CHECK(url_encoded("t-poses-1a2b3c4d") == "t-poses-1a2b3c4d");
  CHECK(url_encoded("a/b?c=d&e f") == "a%2Fb%3Fc%3Dd%26e%20f");
  CHECK(url_encoded("ö\r\n") == "%C3%B6%0D%0A");
}

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

TEST_CASE("an error reply keeps its form", "[tools]") {
  // nlohmann's json makes an array of what stands alone in braces.
  const refused e(json{{"type", "error"}});
  CHECK(e.reply.is_object());
}
