#include "actors/builds/build_fetcher.hpp"

#include "actors/builds/build_keeper.hpp"
#include "actors/builds/limits.hpp"
#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/build_pieces.hpp"
#include "messages/failure.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"
#include "test/fixture.hpp"

#include <map>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr auto npos = std::string::npos;

/// What a node on paper answers.
enum class source_mood { honest, liar, silent, stops_early, forger, hasty };

/// A fetcher and its keeper with a real disk, and sources on paper.
struct fetch_fixture {
  fetch_fixture() {
    skill.write("data", std::string(5 * build_piece_bytes, 'a'));
    skill.write("skill.json", "{}");
    build = value_of(describe_folder(skill.path()));
    start();
  }

  ~fetch_fixture() {
    time.kill(fetcher);
    time.kill(keeper);
  }

  void start() {
    build_keeper_config keeping;
    keeping.context = time.context;
    keeping.folder = data.path();
    keeping.most_bytes = 100 * build_piece_bytes;
    keeping.architecture = "amd64";
    keeper = spawn(time.system, time.context, build_keeper, keeping);
    build_fetcher_config config;
    config.context = time.context;
    config.node = "here";
    config.keeper = keeper;
    config.ask = [this](const build_fetcher_actor&, const source_question& x) {
      asked.push_back(x);
    };
    fetcher = spawn(time.system, time.context, build_fetcher, config);
  }

  auto fetch(const std::vector<std::string>& from) {
    fetch_build what{build.name, "line", {}};
    for (const auto& x : from)
      what.sources.push_back({x, "10.0.0.1:1", "permit of " + x});
    auto result = time.ask<build_fetched>(fetcher, what);
    time.settle();
    return result;
  }

  void answer(const source_question& x) {
    source_answered reply;
    reply.question = x.number;
    const auto mood = moods[x.source.node];
    const auto pieces = x.target.find("/pieces/");
    if (mood == source_mood::silent
        || (mood == source_mood::stops_early && given[x.source.node] > 1)) {
      reply.why = {error_code::timeout, "it does not answer", "", "", ""};
    } else if (x.target.find("/manifest") != std::string::npos) {
      reply.status = 200;
      reply.body = mood == source_mood::forger ? R"({"files":[],"pieces":[]})"
                                               : build.text;
    } else if (pieces == std::string::npos) {
      reply.status = 200;
      reply.body = R"({"pieces":")"
                   + std::string(build.manifest.pieces.size(),
                                 mood == source_mood::hasty ? '0' : '1')
                   + R"(","whole":true})";
    } else {
      const auto i = std::stoul(x.target.substr(pieces + 8));
      reply.status = 200;
      reply.body = value_of(read_piece(skill.path(), build.manifest, i));
      ++given[x.source.node];
      if (mood == source_mood::liar)
        reply.body.back() = 'x';
    }
    caf::anon_send(fetcher, std::move(reply));
    time.settle();
  }

  /// Answers all questions, and those that come of it.
  void answer_all() {
    while (!asked.empty()) {
      const auto next = asked.front();
      asked.erase(asked.begin());
      answer(next);
    }
  }

  bool is_here() const {
    return std::filesystem::exists(build_store::skills_in(data.path())
                                   / build.name.hash)
           || std::filesystem::exists(data.path() / "kept" / build.name.hash);
  }

  temp_folder skill;
  temp_folder data;
  described_build build;
  virtual_time time;
  build_keeper_actor keeper;
  build_fetcher_actor fetcher;
  std::vector<source_question> asked;
  std::map<std::string, source_mood> moods;
  std::map<std::string, size_t> given;
};

} // namespace

TEST_CASE_METHOD(fetch_fixture, "a build comes from all that have it",
                 "[builds]") {
  const auto result = fetch({"a", "b"});
  answer_all();
  REQUIRE(*result);
  CHECK(**result);
  CHECK(given["a"] > 0);
  CHECK(given["b"] > 0);
  CHECK(is_here());
}

TEST_CASE_METHOD(fetch_fixture, "each question has the permit of its source",
                 "[builds]") {
  fetch({"a", "b"});
  for (const auto& x : asked)
    CHECK(x.source.permit == "permit of " + x.source.node);
}

TEST_CASE_METHOD(fetch_fixture, "who gives other bytes is asked no more",
                 "[builds]") {
  moods["b"] = source_mood::liar;
  const auto result = fetch({"a", "b"});
  answer_all();
  REQUIRE(*result);
  CHECK(**result);
  CHECK(given["b"] <= limits::build::questions_of_source);
}

TEST_CASE_METHOD(fetch_fixture,
                 "a source that stalls holds up a fetch for seconds only",
                 "[builds]") {
  const auto result = fetch({"a", "b"});
  std::vector<source_question> stalled;
  while (!asked.empty()) {
    const auto next = asked.front();
    asked.erase(asked.begin());
    if (next.source.node == "b" && next.target.find("/pieces/") != npos)
      stalled.push_back(next);
    else
      answer(next);
  }
  REQUIRE_FALSE(stalled.empty());
  CHECK_FALSE(is_here());
  time.advance(limits::build::slow);
  answer_all();
  CHECK(is_here());
  REQUIRE(*result);
  CHECK(**result);
}

TEST_CASE_METHOD(fetch_fixture,
                 "who says the same again without waiting is asked no more",
                 "[builds]") {
  moods["a"] = source_mood::hasty;
  const auto result = fetch({"a"});
  constexpr int enough = 10;
  for (int i = 0; i < enough && !asked.empty(); ++i) {
    const auto next = asked.front();
    asked.erase(asked.begin());
    answer(next);
  }
  CHECK(asked.empty());
  REQUIRE(*result);
  CHECK(to_failure((**result).error()).code == error_code::unreachable);
}

TEST_CASE_METHOD(fetch_fixture,
                 "a forged manifest is refused and another source asked",
                 "[builds]") {
  moods["a"] = source_mood::forger;
  const auto result = fetch({"a", "b"});
  answer_all();
  REQUIRE(*result);
  CHECK(**result);
}

TEST_CASE_METHOD(fetch_fixture, "where nobody gives it that is said of each",
                 "[builds]") {
  moods["a"] = source_mood::silent;
  moods["b"] = source_mood::liar;
  const auto result = fetch({"a", "b"});
  answer_all();
  REQUIRE(*result);
  REQUIRE_FALSE(**result);
  const auto why = to_failure((*result)->error());
  CHECK(why.code == error_code::unreachable);
  CHECK(why.message.find("a: ") != std::string::npos);
  CHECK(why.message.find("b: ") != std::string::npos);
  CHECK_FALSE(is_here());
}

TEST_CASE_METHOD(fetch_fixture, "a fetch goes on with what has come before",
                 "[builds]") {
  moods["a"] = source_mood::stops_early;
  const auto first = fetch({"a"});
  answer_all();
  REQUIRE(*first);
  CHECK_FALSE(**first);
  // The node is started again.
  time.kill(fetcher);
  time.kill(keeper);
  start();
  const auto second = fetch({"b"});
  answer_all();
  REQUIRE(*second);
  CHECK(**second);
  CHECK(given["b"] < build.manifest.pieces.size());
  CHECK(is_here());
}

TEST_CASE_METHOD(fetch_fixture, "two that want one build wait for one fetch",
                 "[builds]") {
  const auto first = fetch({"a"});
  const auto second = fetch({"a"});
  answer_all();
  REQUIRE(*first);
  REQUIRE(*second);
  CHECK(**first);
  CHECK(**second);
  CHECK(given["a"] == build.manifest.pieces.size());
}

TEST_CASE_METHOD(fetch_fixture, "a build that is here is not fetched",
                 "[builds]") {
  fetch({"a"});
  answer_all();
  const auto again = fetch({});
  REQUIRE(*again);
  CHECK(**again);
  CHECK(asked.empty());
}
