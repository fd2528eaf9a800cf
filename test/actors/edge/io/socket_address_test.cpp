#include "actors/edge/dds/server_inquiry.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/limits.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"

#include <pthread.h>

#include <csignal>
#include <system_error>

using namespace roscell;
using namespace roscell::test::wire;

namespace {

/// While it lives no thread can be made: none has room for its stack.
class no_threads {
public:
  no_threads() {
    pthread_attr_t wanted;
    pthread_attr_init(&wanted);
    pthread_getattr_default_np(&before_);
    pthread_attr_setstacksize(&wanted, size_t{1} << 46);
    REQUIRE(pthread_setattr_default_np(&wanted) == 0);
    pthread_attr_destroy(&wanted);
  }

  ~no_threads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }

  no_threads(const no_threads&) = delete;
  no_threads& operator=(const no_threads&) = delete;

private:
  pthread_attr_t before_{};
};

} // namespace

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

TEST_CASE("a name for which no thread can be had is refused, and looked up "
          "once there is one") {
  {
    const no_threads shortage;
    // More often than lookups may go on at a time.
    for (size_t i = 0; i < 2 * limits::membership::lookups; ++i) {
      const auto found = await_host("localhost", patience);
      REQUIRE(std::holds_alternative<edge_error>(found));
      CHECK(std::get<edge_error>(found).message.find("no thread can be had")
            != std::string::npos);
    }
  }
  CHECK(std::get<std::string>(await_host("localhost", patience))
        == "127.0.0.1");
}

TEST_CASE("whoever asks from the io thread hears that no thread can be had") {
  io_thread io;
  inbox<edge_result<std::string>> answers;
  {
    const no_threads shortage;
    look_up_host(io.core(), "localhost", patience,
                 [&](auto x) { answers.put(x); });
    CHECK(std::holds_alternative<edge_error>(answers.take()));
  }
}

TEST_CASE("a discovery server for which no thread can be had is not looked "
          "for, and nothing else ends") {
  server_inquiry_options options;
  options.server_address = "127.0.0.1";
  options.server_port = 11811;
  options.address = "127.0.0.1";
  const no_threads shortage;
  const auto opened = server_inquiry::open(options, [](const auto&) {});
  REQUIRE(std::holds_alternative<edge_error>(opened));
  CHECK(std::get<edge_error>(opened).message.find("no thread can be had")
        != std::string::npos);
}

TEST_CASE("an io thread that cannot be had leaves the signals as they were") {
  sigset_t before;
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  {
    const no_threads shortage;
    CHECK_THROWS_AS(io_thread{}, std::system_error);
  }
  sigset_t after;
  pthread_sigmask(SIG_SETMASK, nullptr, &after);
  CHECK(sigismember(&before, SIGTERM) == sigismember(&after, SIGTERM));
}

TEST_CASE("of many hosts those that resolve are given, with their ports") {
  const auto found =
      await_hosts({"10.0.0.1", "localhost:7410", "nobody.invalid"}, patience);
  CHECK(found.addresses
        == std::vector<std::string>{"10.0.0.1", "127.0.0.1:7410"});
  CHECK(found.problem.find("'nobody.invalid'") != std::string::npos);
}
