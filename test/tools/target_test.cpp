#include "tools/roscell/client/target.hpp"

#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

/// Sets environment variables and puts the old ones back.
class environment {
public:
  void set(const std::string& name, const std::string& value) {
    keep(name);
    setenv(name.c_str(), value.c_str(), 1);
  }

  void unset(const std::string& name) {
    keep(name);
    unsetenv(name.c_str());
  }

  ~environment() {
    for (const auto& [name, value] : old_)
      value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
  }

private:
  void keep(const std::string& name) {
    const auto* value = std::getenv(name.c_str());
    old_.emplace(name, value == nullptr ? std::nullopt
                                        : std::optional<std::string>{value});
  }

  std::map<std::string, std::optional<std::string>> old_;
};

/// A file with this content, gone at the end of the test.
struct token_file {
  fs::path path =
      fs::temp_directory_path() / ("roscell-token-" + std::to_string(getpid()));
  explicit token_file(const std::string& content) {
    std::ofstream{path} << content;
  }
  ~token_file() {
    fs::remove(path);
  }
};

const target elsewhere = parse_target("203.0.113.1");

} // namespace

TEST_CASE("a target without a port means the default port", "[tools]") {
  const auto t = parse_target("192.168.1.10");
  CHECK(t.host == "192.168.1.10");
  CHECK(t.port == 8420);
  CHECK_FALSE(t.is_local());
  CHECK(t.text() == "192.168.1.10:8420");
}

TEST_CASE("a target may name its port", "[tools]") {
  CHECK(parse_target("robot.local:80").host == "robot.local");
  CHECK(parse_target("robot.local:80").port == 80);
  CHECK(parse_target("[::1]:99").text() == "[::1]:99");
  CHECK(parse_target("[::1]").port == 8420);
}

TEST_CASE("a path or a unix: address is a socket", "[tools]") {
  CHECK(parse_target("/run/node.sock").socket == "/run/node.sock");
  CHECK(parse_target("unix:/run/node.sock").socket == "/run/node.sock");
  CHECK(parse_target("/run/node.sock").text() == "unix:/run/node.sock");
}

TEST_CASE("a path is never taken for the name of a host", "[tools]") {
  for (const auto* text : {"a/b.sock", "./node.sock", "unix:a/b.sock"})
    CHECK_THROWS_WITH(parse_target(text),
                      Catch::Contains("named by its absolute path"));
}

TEST_CASE("a target that cannot be meant is refused", "[tools]") {
  for (const auto* text : {"", ":80", "host:", "host:0", "host:65536",
                           "host:8o", "unix:", "unix:relative", "[::1",
                           "[::1]80", "[]:80", "host:80:81", "host:-1"})
    CHECK_THROWS_AS(parse_target(text), std::invalid_argument);
}

TEST_CASE("ROSCELL_TO names the default target", "[tools]") {
  environment env;
  env.set("ROSCELL_TO", "robot:1234");
  CHECK(default_target().text() == "robot:1234");
  env.set("ROSCELL_TO", "robot:none");
  CHECK_THROWS_AS(default_target(), command_error);
}

TEST_CASE("without ROSCELL_TO the target is a local socket", "[tools]") {
  environment env;
  env.unset("ROSCELL_TO");
  CHECK(default_target().socket.filename() == "node.sock");
}

TEST_CASE("a user's own files lie in the state directory", "[tools]") {
  if (geteuid() == 0) {
    CHECK(default_data_dir() == "/var/lib/roscell");
    return;
  }
  environment env;
  env.set("XDG_STATE_HOME", "/x");
  CHECK(default_data_dir() == "/x/roscell");
  env.unset("XDG_STATE_HOME");
  env.set("HOME", "/h");
  CHECK(default_data_dir() == "/h/.local/state/roscell");
}

TEST_CASE("a token file is preferred to ROSCELL_TOKEN", "[tools]") {
  environment env;
  env.set("ROSCELL_TOKEN", "of-environment");
  const token_file file{"abc123\n"};
  CHECK(find_token(file.path, elsewhere) == "abc123");
  CHECK(find_token({}, elsewhere) == "of-environment");
}

TEST_CASE("a token that would break the request is refused", "[tools]") {
  environment env;
  env.set("ROSCELL_TOKEN", "a\r\nHost: evil");
  CHECK_THROWS_AS(find_token({}, elsewhere), command_error);
  const token_file large{std::string(5000, 'a')};
  CHECK_THROWS_AS(find_token(large.path, elsewhere), command_error);
  const token_file empty{"\n"};
  CHECK_THROWS_AS(find_token(empty.path, elsewhere), command_error);
  CHECK_THROWS_AS(find_token("/nowhere/token", elsewhere), command_error);
}

TEST_CASE("another machine does not get this machine's token", "[tools]") {
  environment env;
  env.unset("ROSCELL_TOKEN");
  const auto dir =
      fs::temp_directory_path() / ("roscell-home-" + std::to_string(getpid()));
  env.set("XDG_STATE_HOME", dir.string());
  if (default_data_dir() != dir / "roscell")
    return; // Root's files are not the test's to change.
  fs::create_directories(dir / "roscell");
  std::ofstream{dir / "roscell" / "token"} << "mine";
  CHECK(find_token({}, parse_target("127.0.0.1")) == "mine");
  CHECK(find_token({}, parse_target("localhost")) == "mine");
  CHECK(find_token({}, elsewhere).empty());
  CHECK(find_token({}, parse_target("robot.example")).empty());
  fs::remove_all(dir);
}

TEST_CASE("a token file that is not there is wrong usage, and says why",
          "[tools]") {
  try {
    find_token("/nowhere/token", elsewhere);
    FAIL("there is none");
  } catch (const command_error& e) {
    CHECK(e.code == exit_usage);
    CHECK(std::string{e.what()}
          == "cannot read the token file /nowhere/token: No such file or "
             "directory");
    CHECK(e.hint.find("DATA_DIR/token") != std::string::npos);
  }
}

TEST_CASE("a secret that everybody can read is warned of, and taken",
          "[tools]") {
  const token_file file{"abc"};
  fs::permissions(file.path, fs::perms{0600});
  CHECK(open_secret_warning(file.path).empty());
  fs::permissions(file.path, fs::perms{0640});
  CHECK(open_secret_warning(file.path).empty());
  fs::permissions(file.path, fs::perms{0644});
  CHECK(open_secret_warning(file.path).find("chmod 600 " + file.path.string())
        != std::string::npos);
  CHECK(find_token(file.path, elsewhere) == "abc");
  CHECK(open_secret_warning("/nowhere/token").empty());
}
