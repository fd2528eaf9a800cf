#include "actors/builds/images/image_exchange.hpp"

#include "actors/builds/limits.hpp"
#include "messages/failure.hpp"
#include "test/fixture.hpp"

#include <caf/response_promise.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

const std::string image_id = "sha256:" + std::string(64, 'a');
const std::string layer = "sha256:" + std::string(64, 'b');

/// An exchange, and on paper all whom it works with.
struct exchange_fixture {
  exchange_fixture() {
    parts.broker = as<image_broker_actor>({[this](const image_request& x) {
      requests.push_back(x);
      return answer<image_offered>(
          refusals,
          {image_id, "arm", "line", {{build_hash, build_hash, 7}, {}}});
    }});
    parts.keeper = as<build_keeper_actor>(
        {[this](const take_build& x) {
           taken.push_back(x);
           return build_held{x.name, {}, true};
         },
         [this](const build_query& x) -> caf::result<build_held> {
           if (forgotten)
             return fail(error_code::conflict, "it is not here");
           return build_held{{x.hash, x.hash, 7}, {}, true};
         },
         [this](const drop_build& x) {
           dropped.push_back(x.hash);
           return build_dropped{};
         }});
    parts.fetcher = as<build_fetcher_actor>({[this](const fetch_build& x) {
      fetches.push_back(x);
      return answer<build_fetched>(fetch_failures, {x.name.hash});
    }});
    image_exchange_config config;
    config.context = time.context;
    config.node = "leg";
    config.architecture = "amd64";
    config.builds = "/builds";
    config.most_bytes = 100;
    config.make_worker = [this](const image_exchange_actor&) {
      ++workers;
      return make_worker();
    };
    exchange = spawn(time.system, time.context, image_exchange, config);
    caf::anon_send(exchange, parts);
    time.settle();
  }

  ~exchange_fixture() {
    time.kill(exchange);
    for (const auto& x : actors)
      time.kill(x);
  }

  template <class Handle>
  Handle as(caf::behavior how) {
    const auto actor =
        time.system.spawn([how](caf::event_based_actor*) { return how; });
    actors.push_back(actor);
    return caf::actor_cast<Handle>(actor);
  }

  /// The next failure of a list, while there is one.
  template <class Reply>
  static caf::result<Reply> answer(std::vector<failure>& failures,
                                   Reply reply) {
    if (failures.empty())
      return reply;
    const auto why = failures.front();
    failures.erase(failures.begin());
    return to_error(why);
  }

  image_worker_actor make_worker() {
    return as<image_worker_actor>(
        {[](const image_query& x) {
           return x.image == "debian:1" ? image_known{image_id, 7}
                                        : image_known{};
         },
         [this](const list_layers&) { return layers_listed{layers}; },
         [this](const save_image& x) {
           saved.push_back(x);
           return answer<image_saved>(
               save_failures,
               {{build_hash, build_hash, 7}, "text", "/builds/images/x"});
         },
         [this](const load_image& x) {
           loaded.push_back(x);
           return answer<image_loaded>(load_failures, {});
         }});
  }

  auto bring(const std::string& image = "debian:1") {
    auto result = time.ask<image_brought>(exchange, bring_image{image});
    time.settle();
    return result;
  }

  auto share(const std::vector<std::string>& without = {}) {
    auto result = time.ask<image_shared>(
        exchange, image_sharing{image_id, "line", without});
    time.settle();
    return result;
  }

  const std::string build_hash = std::string(64, 'c');
  virtual_time time;
  serve_images parts;
  std::vector<caf::actor> actors;
  image_exchange_actor exchange;
  int workers = 0;
  bool forgotten = false;
  std::vector<std::string> layers;
  std::vector<failure> refusals, fetch_failures, save_failures, load_failures;
  std::vector<image_request> requests;
  std::vector<take_build> taken;
  std::vector<fetch_build> fetches;
  std::vector<save_image> saved;
  std::vector<load_image> loaded;
  std::vector<std::string> dropped;
};

error_code code_of(const caf::expected<image_brought>& x) {
  return to_failure(x.error()).code;
}

} // namespace

TEST_CASE_METHOD(exchange_fixture, "an image comes as a build and is loaded",
                 "[images]") {
  layers = {layer};
  const auto result = bring();
  REQUIRE(*result);
  REQUIRE(**result);
  CHECK((**result)->image_id == image_id);
  CHECK((**result)->node == "arm");
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].layers == layers);
  CHECK(requests[0].architecture == "amd64");
  REQUIRE(fetches.size() == 1);
  CHECK(fetches[0].cell == "line");
  REQUIRE(loaded.size() == 1);
  CHECK(loaded[0].image_id == image_id);
  CHECK(loaded[0].folder == "/builds/kept/" + build_hash);
}

TEST_CASE_METHOD(exchange_fixture, "two that want one image wait for one way",
                 "[images]") {
  const auto first = time.ask<image_brought>(exchange, bring_image{"debian:1"});
  const auto second = bring();
  CHECK(**first);
  CHECK(**second);
  CHECK(loaded.size() == 1);
}

TEST_CASE_METHOD(exchange_fixture, "where a source fails another one is asked",
                 "[images]") {
  fetch_failures = {{error_code::unreachable, "no node gives the build"}};
  CHECK(**bring());
  CHECK(requests.size() == 2);
  fetch_failures.assign(limits::image::attempts,
                        {error_code::unreachable, "no node gives the build"});
  CHECK(code_of(**bring("other:1")) == error_code::unreachable);
  CHECK(requests.size() == 2 + limits::image::attempts);
}

TEST_CASE_METHOD(exchange_fixture,
                 "an engine that takes no image in part gets the whole of it",
                 "[images]") {
  layers = {layer};
  load_failures = {{error_code::engine_failed, "no such layer"}};
  CHECK(**bring());
  REQUIRE(requests.size() == 2);
  CHECK(requests[1].layers.empty());
}

TEST_CASE_METHOD(exchange_fixture,
                 "what is not the promised image is dropped and its node named",
                 "[images]") {
  load_failures = {{error_code::schema_violation, "another image"}};
  const auto result = bring();
  CHECK(code_of(**result) == error_code::schema_violation);
  CHECK(to_failure((*result)->error()).message == "node 'arm': another image");
  CHECK(dropped == std::vector<std::string>{build_hash});
}

TEST_CASE_METHOD(exchange_fixture, "an image that no node has is refused",
                 "[images]") {
  refusals = {{error_code::conflict, "no node of the cell has the image"}};
  CHECK(code_of(**bring()) == error_code::conflict);
  CHECK(fetches.empty());
}

TEST_CASE_METHOD(exchange_fixture, "an image is saved once for all who want it",
                 "[images]") {
  const auto first =
      time.ask<image_shared>(exchange, image_sharing{image_id, "line", {}});
  const auto second = share();
  CHECK((**first)->build.hash == build_hash);
  CHECK((**second)->build.hash == build_hash);
  CHECK(**share());
  REQUIRE(saved.size() == 1);
  CHECK(saved[0].most_bytes == 100);
  CHECK(taken.size() == 1);
  // What is left out makes another build.
  CHECK(**share({layer}));
  CHECK(saved.size() == 2);
}

TEST_CASE_METHOD(exchange_fixture,
                 "an image that went for room is saved once more", "[images]") {
  CHECK(**share());
  forgotten = true;
  CHECK(**share());
  CHECK(saved.size() == 2);
}

TEST_CASE_METHOD(exchange_fixture, "an image that cannot be saved is told",
                 "[images]") {
  save_failures = {{error_code::conflict, "the disk is full"}};
  const auto result = share();
  REQUIRE_FALSE(**result);
  CHECK(to_failure((*result)->error()).message == "the disk is full");
  CHECK(taken.empty());
  CHECK(**share());
}

TEST_CASE_METHOD(exchange_fixture, "a worker that has ended is made again",
                 "[images]") {
  CHECK(**share());
  CHECK(workers == 1);
  time.kill(actors.back());
  CHECK(**share({layer}));
  CHECK(workers == 2);
}

TEST_CASE_METHOD(exchange_fixture, "an idle node has no worker", "[images]") {
  time.advance(std::chrono::minutes{1});
  CHECK(workers == 0);
}
