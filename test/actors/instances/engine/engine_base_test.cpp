#include "test/actors/instances/engine/engine_bench.hpp"

#include "schemas/utf8.hpp"

#include <atomic>

/// Where the engine runtime gets the base image of a skill's image.
namespace roscell::test {

namespace {

const std::string base_id = "sha256:" + std::string(64, 'a');
const std::string base_digest = "sha256:" + std::string(64, 'd');

/// A cell on paper, which has an image or not.
struct base_bench : engine_bench {
  base_bench() {
    script.on("GET /images/base:1/json", 404, R"({"message":"none"})");
    script.on("POST /build",
              [this](engine_caller& who, const engine_call_seen& what) {
                built.put(what.body.substr(what.body.find("FROM "), 80));
                who.open();
                who.end();
              });
    using handle = image_exchange_actor;
    exchange = system.spawn([this](handle::pointer) -> handle::behavior_type {
      return {
          [](const state_query&) { return state_of({}); },
          [this](const bring_image& x) -> caf::result<image_brought> {
            asked.put(x.image);
            if (!has_image)
              return fail(error_code::conflict, "no node has it");
            return image_brought{base_id, "arm", 7};
          },
          [](const image_query&) { return image_known{}; },
          [](const image_sharing&) { return image_shared{}; },
          [](const serve_images&) {},
      };
    });
  }

  ~base_bench() {
    end_and_await(self, exchange);
  }

  /// The runtime anew, with the cell.
  void join_cell() {
    end_and_await(self, runtime);
    config.images = exchange;
    begin_runtime();
  }

  prepare_image pinned() const {
    auto result = image();
    result.base_image = "base@" + base_digest;
    return result;
  }

  /// A registry from which the engine can pull.
  void can_pull(const std::string& lines) {
    script.on("POST /images/create", [=](engine_caller& who,
                                         const engine_call_seen& what) {
      pulled.put(what.target);
      who.open();
      who.chunk(lines);
      who.end();
      script.on("GET /images/base:1/json", 200, json{{"Id", base_id}}.dump());
    });
  }

  image_exchange_actor exchange;
  std::atomic<bool> has_image{true};
  event_inbox asked, built, pulled;
};

} // namespace

TEST_CASE_METHOD(base_bench, "a base image comes from the cell first",
                 "[images]") {
  join_cell();
  CHECK(get<image_prepared>(image()).image.rfind("roscell/echo:", 0) == 0);
  CHECK(asked.take() == "base:1");
  CHECK(built.take().rfind("FROM base:1\n", 0) == 0);
}

TEST_CASE_METHOD(base_bench, "an image that no node has is pulled",
                 "[images]") {
  has_image = false;
  join_cell();
  can_pull("{\"status\":\"Pulling from base\"}\n");
  get<image_prepared>(image());
  CHECK(pulled.take() == "/images/create?fromImage=base&tag=1");
  reported_events.await("image_not_fetched base:1");
  reported_events.await("image_pulled base:1");
}

TEST_CASE_METHOD(base_bench, "a registry is asked with the login of this host",
                 "[images]") {
  const auto file = folder.write(
      "config.json",
      json{{"auths", {{"docker.io", {{"auth", to_base64("me:secret")}}}}}}
          .dump());
  end_and_await(self, runtime);
  config.logins.files = {file};
  begin_runtime();
  can_pull("");
  get<image_prepared>(image());
  // The fake engine does not show headers; that it was asked is enough here.
  CHECK(pulled.take() == "/images/create?fromImage=base&tag=1");
}

TEST_CASE_METHOD(base_bench, "why a registry gives nothing is told with it",
                 "[images]") {
  can_pull("{\"error\":\"toomanyrequests: slow down\"}\n");
  const auto why = refusal<image_prepared>(image());
  CHECK(why.message.find("the image of 'echo' cannot be built: registry "
                         "'docker.io' was asked too often")
        != std::string::npos);
  CHECK(why.hint.find("docker pull base:1") != std::string::npos);
}

TEST_CASE_METHOD(base_bench, "a login that cannot be found out is told",
                 "[images]") {
  end_and_await(self, runtime);
  config.logins.own = folder.path() / "none.json";
  begin_runtime();
  CHECK(refusal<image_prepared>(image()).hint.find("--registry-auth")
        != std::string::npos);
}

TEST_CASE_METHOD(base_bench,
                 "an image that is named by a digest is built on by its id",
                 "[images]") {
  join_cell();
  get<image_prepared>(pinned());
  CHECK(asked.take() == "base@" + base_digest);
  CHECK(built.take().rfind("FROM " + base_id + "\n", 0) == 0);
}

TEST_CASE_METHOD(base_bench,
                 "an image that came by its digest before is known by it",
                 "[images]") {
  join_cell();
  script.on("GET /images/roscell-pinned:" + std::string(32, 'd') + "/json", 200,
            json{{"Id", base_id}}.dump());
  get<image_prepared>(pinned());
  CHECK(built.take().rfind("FROM " + base_id + "\n", 0) == 0);
}

TEST_CASE_METHOD(base_bench, "the oldest images of skills are removed",
                 "[images]") {
  script.on("GET /images/base:1/json", 200);
  end_and_await(self, runtime);
  config.kept_images = 1;
  begin_runtime();
  script.on("GET /images/json", 200,
            R"([{"Id":"sha256:1","RepoTags":["roscell/echo:old"],"Created":1},
                {"Id":"sha256:2","RepoTags":["roscell/echo:run"],"Created":2},
                {"Id":"sha256:3","RepoTags":["roscell/echo:new"],"Created":3}])");
  script.on("GET /containers/json?all=1", 200, R"([{"ImageID":"sha256:2"}])");
  script.on("DELETE /images/roscell/echo:old", 200, "[]");
  get<image_prepared>(image());
  reported_events.await("image_removed roscell/echo:old");
}

} // namespace roscell::test
