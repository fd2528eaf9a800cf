#include "actors/edge/io/name_lookup.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

using namespace roscell;
using namespace roscell::test::wire;

TEST_CASE("a host is an IPv4 address or a name, with or without a port") {
  CHECK(to_string(*parse_host_address("10.0.0.1", 11811)) == "10.0.0.1:11811");
  CHECK(to_string(*parse_host_address("base.local", 11811))
        == "base.local:11811");
  CHECK(to_string(*parse_host_address("my_host-1:12000", 11811))
        == "my_host-1:12000");
}

TEST_CASE("what can be neither an address nor a name is refused") {
  for (const auto* text :
       {"", ":11811", "10.0.0", "10.0.0.999", "300", "a b", "base:", "base:0",
        "base:70000", "base:port", "-base", ".base", "base/x", "fe80::1"}) {
    INFO(text);
    CHECK_FALSE(parse_host_address(text, 11811));
  }
  CHECK_FALSE(parse_host_address(std::string(254, 'a'), 11811));
  CHECK_FALSE(parse_host_address("base"));
}

TEST_CASE("a host that is an address is answered as it is") {
  io_thread io;
  inbox<edge_result<std::string>> answers;
  look_up_host(io.core(), "10.0.0.1", 1s, [&](auto x) { answers.put(x); });
  CHECK(std::get<std::string>(answers.take()) == "10.0.0.1");
  CHECK(std::get<std::string>(await_host("10.0.0.1", 0ms)) == "10.0.0.1");
}

TEST_CASE("this host's own name resolves, for who waits and who does not") {
  io_thread io;
  inbox<edge_result<std::string>> answers;
  look_up_host(io.core(), "localhost", patience,
               [&](auto x) { answers.put(x); });
  CHECK(std::get<std::string>(answers.take()) == "127.0.0.1");
  CHECK(std::get<std::string>(await_host("localhost", patience))
        == "127.0.0.1");
}

TEST_CASE("a name that nobody has is told with a remedy") {
  // RFC 6761: nobody ever has it.
  const auto found = await_host("nobody.invalid", patience);
  REQUIRE(std::holds_alternative<edge_error>(found));
  const auto& why = std::get<edge_error>(found);
  CHECK(why.message.find("'nobody.invalid' does not resolve")
        != std::string::npos);
  CHECK(why.hint.find("IPv4 address") != std::string::npos);
}

TEST_CASE("a name that is being looked up keeps no io thread from stopping") {
  inbox<edge_result<std::string>> answers;
  {
    io_thread io;
    look_up_host(io.core(), "nobody.invalid", patience,
                 [&](auto x) { answers.put(x); });
    settle(io);
  }
  CHECK(std::holds_alternative<edge_error>(answers.take()));
}

TEST_CASE("of many hosts those that resolve are given, with their ports") {
  const auto found =
      await_hosts({"10.0.0.1", "localhost:7410", "nobody.invalid"}, patience);
  CHECK(found.addresses
        == std::vector<std::string>{"10.0.0.1", "127.0.0.1:7410"});
  CHECK(found.trouble.find("'nobody.invalid'") != std::string::npos);
}
