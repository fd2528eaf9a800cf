#include "actors/instances/secrets/secret_keeper.hpp"

#include "actors/edge/disk/limits.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"
#include "test/fixture.hpp"
#include "test/temp_folder.hpp"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

using words = std::vector<std::string>;

std::string text_in(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// A keeper between a folder on the disk and one in memory.
struct keeper_bench : virtual_time {
  keeper_bench() {
    config.context = context;
    config.context.events = caf::actor_cast<event_log_actor>(
        system.spawn([this]() -> caf::behavior {
          return {[this](const record_event& x) { published.push_back(x); }};
        }));
    config.node = "arm";
    config.folder = data.path() / "secrets";
    config.places = {"/dev/shm"};
    config.place_name = "roscell-test-" + std::to_string(::getpid());
    config.names = std::make_shared<secret_names>();
    fs::remove_all(memory());
    start();
  }

  ~keeper_bench() {
    kill(keeper);
    kill(config.context.events);
    fs::remove_all(memory());
  }

  fs::path memory() const {
    return fs::path{"/dev/shm"} / config.place_name;
  }

  void start() {
    keeper = spawn(system, config.context, secret_keeper, config);
    settle();
  }

  void start_again() {
    kill(keeper);
    start();
  }

  template <class Reply, class Request>
  caf::expected<Reply> say(const Request& request) {
    auto reply = ask<Reply>(keeper, request);
    settle();
    return **reply;
  }

  caf::expected<secret_set> set(const std::string& name,
                                const std::string& value) {
    return say<secret_set>(secret_setting{name, to_base64(value)});
  }

  caf::expected<secrets_laid_out> lay_out(const words& files,
                                          const words& variables = {}) {
    return say<secrets_laid_out>(lay_out_secrets{"i", files, variables, ""});
  }

  secret_list list() {
    return *say<secret_list>(secret_query{});
  }

  template <class Reply>
  static std::string refusal(const caf::expected<Reply>& reply) {
    REQUIRE_FALSE(reply);
    const auto why = to_failure(reply.error());
    return why.message + " | " + why.hint;
  }

  temp_folder data;
  secret_keeper_config config;
  std::vector<record_event> published;
  secret_keeper_actor keeper;
};

} // namespace

TEST_CASE("a node keeps a secret over its restarts, and tells its name only",
          "[secrets]") {
  keeper_bench b;
  CHECK_FALSE(b.set("key", "hidden")->replaced);
  CHECK(b.set("key", "hidden2")->replaced);
  b.start_again();
  const auto known = b.list();
  REQUIRE(known.secrets.size() == 1);
  CHECK(known.secrets[0].name == "key");
  CHECK(known.secrets[0].set_unix_ms > 0);
  CHECK(b.config.names->get() == words{"key"});
  CHECK(b.lay_out({}, {"key"})->values == words{"hidden2"});
}

TEST_CASE("an instance finds its secrets in files and variables", "[secrets]") {
  keeper_bench b;
  b.set("key", "one");
  b.set("pass", "two");
  const auto given = b.lay_out({"key", "key"}, {"pass", "key"});
  REQUIRE(given);
  CHECK(given->folder == b.memory() / "i");
  CHECK(text_in(b.memory() / "i/key") == "one");
  CHECK_FALSE(fs::exists(b.memory() / "i/pass"));
  CHECK(given->values == words{"two", "one"});
  CHECK(b.list().secrets[1].instances == words{"i"});
  CHECK(b.lay_out({}, {"pass"})->folder.empty());
  CHECK_FALSE(fs::exists(b.memory() / "i"));
}

TEST_CASE("an instance that starts again gets a secret as it is now",
          "[secrets]") {
  keeper_bench b;
  b.set("key", "old");
  b.lay_out({"key"});
  b.set("key", "new");
  CHECK(text_in(b.memory() / "i/key") == "old");
  b.lay_out({"key"});
  CHECK(text_in(b.memory() / "i/key") == "new");
}

TEST_CASE("a secret that is not there is named, and what sets it",
          "[secrets]") {
  keeper_bench b;
  const std::string why =
      "node 'arm' has no secret 'key' | `roscell secret set key` there";
  CHECK(b.refusal(b.lay_out({"key"})) == why);
  CHECK(b.refusal(b.lay_out({}, {"key"})) == why);
  b.set("key", "x");
  CHECK(b.lay_out({"key"}));
  const auto removed = b.say<secret_removed>(secret_removal{"key"});
  REQUIRE(removed);
  CHECK(removed->instances == words{"i"});
  CHECK(b.refusal(b.lay_out({"key"})) == why);
  CHECK_FALSE(fs::exists(b.memory() / "i"));
  CHECK(b.refusal(b.say<secret_removed>(secret_removal{"key"}))
        == "node 'arm' has no secret 'key' | `roscell secret list` shows them");
}

TEST_CASE("files of secrets go when their instance does", "[secrets]") {
  keeper_bench b;
  b.set("key", "x");
  b.lay_out({"key"});
  caf::anon_send(b.keeper, clear_secrets{"i"});
  b.settle();
  CHECK_FALSE(fs::exists(b.memory() / "i"));
  CHECK(b.list().secrets[0].instances.empty());
}

TEST_CASE("a node that starts leaves files only to what may still run",
          "[secrets]") {
  keeper_bench b;
  b.set("key", "x");
  b.lay_out({"key"});
  b.say<secrets_laid_out>(lay_out_secrets{"gone", {"key"}, {}, ""});
  b.config.given = {{"i", {"key"}}};
  b.start_again();
  CHECK(text_in(b.memory() / "i/key") == "x");
  CHECK_FALSE(fs::exists(b.memory() / "gone"));
  CHECK(b.list().secrets[0].instances == words{"i"});
}

TEST_CASE("a value that no node keeps is refused, and not shown", "[secrets]") {
  keeper_bench b;
  const auto refused = [&](const std::string& value) {
    const auto why = b.refusal(b.say<secret_set>(secret_setting{"key", value}));
    CHECK(why.find(value.substr(0, 8)) == std::string::npos);
    return why.substr(0, why.find(" |"));
  };
  CHECK(refused("hidden!!") == "the value is no base64");
  CHECK(refused(to_base64(std::string(limits::secret::bytes + 1, 'x')))
        == "the value has 65537 bytes, and may have 65536");
  CHECK(b.list().secrets.empty());
  CHECK(b.set("key", std::string(limits::secret::bytes, 'x')));
}

TEST_CASE("a node keeps so many secrets, and no more", "[secrets]") {
  keeper_bench b;
  for (size_t i = 0; i < limits::secret::most; ++i)
    b.data.write("secrets/s" + std::to_string(i) + ".secret", "x");
  b.start_again();
  CHECK(b.refusal(b.set("more", "x"))
        == "node 'arm' keeps 256 secrets already | `roscell secret remove` "
           "removes one");
  CHECK(b.set("s7", "other")->replaced);
}

TEST_CASE("bytes that are no text are for files only", "[secrets]") {
  keeper_bench b;
  for (const auto& bytes : {std::string{"a\0b", 3}, std::string{"\xff"}}) {
    b.set("key", bytes);
    CHECK(b.refusal(b.lay_out({}, {"key"}))
          == "the secret 'key' is no text, and cannot be a variable | name it "
             "in `secrets`, for a file");
    CHECK(b.lay_out({"key"}));
    CHECK(text_in(b.memory() / "i/key") == bytes);
  }
}

TEST_CASE("a foreign file among the secrets is told, and harms nobody",
          "[secrets]") {
  keeper_bench b;
  b.set("key", "x");
  b.data.write("secrets/notes", "x");
  b.published.clear();
  b.start_again();
  CHECK(b.list().secrets.size() == 1);
  REQUIRE(b.published.size() == 1);
  CHECK(b.published[0].what == "secret_ignored");
}

TEST_CASE("no event and no state of the keeper has a value", "[secrets]") {
  keeper_bench b;
  b.set("key", "hidden-value");
  b.lay_out({"key"}, {"key"});
  b.say<secret_removed>(secret_removal{"key"});
  const auto hidden = [](const std::string& text) {
    return text.find("hidden-value") == std::string::npos
           && text.find(to_base64("hidden-value")) == std::string::npos;
  };
  REQUIRE(b.published.size() == 2);
  for (const auto& x : b.published)
    CHECK(hidden(x.subject + x.data));
  CHECK(hidden(b.say<actor_state>(state_query{})->json_text));
}
