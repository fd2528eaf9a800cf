#include "actors/edge/engine/engine_search.hpp"
#include "test/actors/edge/io/edge_fixture.hpp"
#include "test/fake_engine.hpp"

#include <unistd.h>

#include <cstdlib>
#include <utility>

namespace roscell::test::wire {

namespace {

/// The variables that tell of engines, none of them set but those of a test.
struct engine_variables {
  engine_variables() {
    clear();
  }

  ~engine_variables() {
    clear();
  }

  engine_variables(const engine_variables&) = delete;
  engine_variables& operator=(const engine_variables&) = delete;

  static void set(const char* name, const std::string& value) {
    ::setenv(name, value.c_str(), 1);
  }

private:
  static void clear() {
    for (const char* name :
         {"DOCKER_HOST", "CONTAINER_HOST", "XDG_RUNTIME_DIR"})
      ::unsetenv(name);
  }
};

/// An engine that answers this to one question, and knows no other.
struct engine_that_says {
  engine_that_says(const std::string& path, const std::string& answer)
      : engine(folder / "s",
               [=](engine_caller& who, const engine_call_seen& what) {
                 if (what.target == path)
                   who.reply(200, answer);
                 else
                   who.reply(404, R"({"message":"page not found"})");
               }) {
    // nop
  }

  edge_result<found_engine> found() const {
    return ask_for_engine(folder / "s");
  }

  temp_folder folder;
  fake_engine engine;
};

} // namespace

TEST_CASE("engines are looked for where their users have them") {
  engine_variables variables;
  const auto own = "/run/user/" + std::to_string(::geteuid());
  using paths = std::vector<std::string>;
  CHECK(engine_sockets("auto")
        == paths{"/var/run/docker.sock", own + "/docker.sock",
                 own + "/podman/podman.sock", "/run/podman/podman.sock"});
  variables.set("XDG_RUNTIME_DIR", "/x");
  variables.set("DOCKER_HOST", "unix:///d");
  variables.set("CONTAINER_HOST", "unix:///c");
  CHECK(engine_sockets("docker")
        == paths{"/d", "/var/run/docker.sock", "/x/docker.sock"});
  CHECK(engine_sockets("podman")
        == paths{"/c", "/x/podman/podman.sock", "/run/podman/podman.sock"});
  variables.set("DOCKER_HOST", "tcp://far:2375");
  CHECK(engine_sockets("docker").front() == "/var/run/docker.sock");
}

TEST_CASE("an engine is known by what only it answers") {
  const auto docker =
      expect(engine_that_says{"/version", R"({"Version":"20.10.24"})"}.found());
  CHECK(docker.name == "docker");
  CHECK(docker.version == "20.10.24");
  CHECK(expect(engine_that_says{"/libpod/_ping", "OK"}.found()).name
        == "podman");
}

TEST_CASE("an engine whose socket is a user's runs without root") {
  const engine_that_says engine{"/libpod/_ping", "OK"};
  const auto socket = engine.folder / "s";
  CHECK(expect(engine.found()).rootless == (::geteuid() != 0));
  if (::chown(socket.c_str(), 65534, 65534) == 0)
    CHECK(expect(engine.found()).rootless);
}

TEST_CASE("the engine that answers first is taken, whatever its name") {
  const engine_that_says engine{"/libpod/_ping", "OK"};
  const auto socket = engine.folder / "s";
  CHECK(expect(find_engine({engine.folder / "none", socket})).socket == socket);
}

TEST_CASE("what is no engine is not taken for one") {
  CHECK(expect_error(engine_that_says{"/version", "<html>"}.found()).code
        == error_code::engine_failed);
  CHECK(expect_error(engine_that_says{"/libpod/_ping", "<html>"}.found()).code
        == error_code::engine_failed);
}

} // namespace roscell::test::wire
