#include "actors/builds/fetch_table.hpp"

#include "actors/builds/limits.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <string>
#include <vector>

using namespace roscell;

namespace {

constexpr size_t pieces = 20;
constexpr fetch_table::time_point start{};

std::vector<bool> all() {
  return std::vector<bool>(pieces, true);
}

std::vector<bool> only(const std::set<size_t>& which) {
  std::vector<bool> result(pieces, false);
  for (const auto i : which)
    result[i] = true;
  return result;
}

fetch_table table_with(const std::vector<std::string>& sources,
                       uint64_t seed = 1) {
  fetch_table result{std::vector<bool>(pieces, false), seed};
  for (const auto& x : sources) {
    result.add_source(x);
    result.announce(x, all());
  }
  return result;
}

/// Answers all that is asked until nothing more is.
size_t fetch_all(fetch_table& table) {
  size_t questions = 0;
  for (auto asked = table.next(start); !asked.empty();
       asked = table.next(start))
    for (const auto& x : asked) {
      table.take(x);
      ++questions;
    }
  return questions;
}

} // namespace

TEST_CASE("a build comes whole from several sources at once", "[builds]") {
  CHECK(table_with({"a", "b"}).next(start).size()
        == 2 * limits::build::questions_of_source);
  // Of many one at a time, so that what they send is there soon.
  CHECK(table_with({"a", "b", "c"}).next(start).size() == 3);
  auto fresh = table_with({"a", "b", "c"});
  CHECK(fetch_all(fresh) == pieces);
  CHECK(fresh.complete());
  CHECK(fresh.given().size() == 3);
}

TEST_CASE("however many sources there are, so many pieces come at a time",
          "[builds]") {
  std::vector<std::string> sources;
  for (size_t i = 0; i <= limits::build::questions_of_fetch; ++i)
    sources.push_back("s" + std::to_string(i));
  auto table = table_with(sources);
  const auto asked = table.next(start);
  CHECK(asked.size() == limits::build::questions_of_fetch);
  CHECK(table.next(start).empty());
  table.take(asked.front());
  CHECK(table.next(start).size() == 1);
}

TEST_CASE("what is here already is not asked for", "[builds]") {
  fetch_table table{only({0, 1, 2, 3, 4}), 1};
  table.add_source("a");
  table.announce("a", all());
  CHECK(fetch_all(table) == pieces - 5);
  CHECK(table.complete());
}

TEST_CASE("nothing is asked of a source that has not said what it has",
          "[builds]") {
  fetch_table table{std::vector<bool>(pieces, false), 1};
  table.add_source("a");
  CHECK(table.next(start).empty());
  CHECK_FALSE(table.stranded());
  table.announce("a", only({3}));
  const auto asked = table.next(start);
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].piece == 3);
}

TEST_CASE("what few have is asked for first", "[builds]") {
  fetch_table table{std::vector<bool>(pieces, false), 1};
  for (const auto* x : {"a", "b"})
    table.add_source(x);
  table.announce("a", all());
  auto most = all();
  most[7] = most[11] = false;
  table.announce("b", most);
  std::set<size_t> of_a;
  for (const auto& x : table.next(start))
    if (x.source == "a")
      of_a.insert(x.piece);
  CHECK(of_a == std::set<size_t>{7, 11});
}

TEST_CASE("nodes that begin together begin with other pieces", "[builds]") {
  std::set<size_t> first;
  for (uint64_t seed = 0; seed < 10; ++seed)
    first.insert(table_with({"a"}, seed).next(start).front().piece);
  CHECK(first.size() > 4);
}

TEST_CASE("a source that lies is asked no more and the others give the rest",
          "[builds]") {
  auto table = table_with({"honest", "liar"});
  for (const auto& x : table.next(start))
    if (x.source == "liar") {
      table.blame(x, "other bytes");
      break;
    }
  REQUIRE(table.lost().size() == 1);
  CHECK(table.lost()[0].source == "liar");
  for (const auto& x : table.next(start))
    CHECK(x.source == "honest");
}

TEST_CASE("a source is asked again until it has failed often in a row",
          "[builds]") {
  auto table = table_with({"a"});
  for (int i = 1; i < limits::build::failures_in_a_row; ++i)
    table.fail(table.next(start).front(), "timeout");
  CHECK(table.lost().empty());
  SECTION("a piece in between counts it anew") {
    table.take(table.next(start).front());
    table.fail(table.next(start).front(), "timeout");
    CHECK(table.lost().empty());
  }
  SECTION("one more is too many") {
    table.fail(table.next(start).front(), "timeout");
    CHECK(table.lost().size() == 1);
    CHECK(table.stranded());
  }
}

TEST_CASE("the last pieces are asked of a second source once the first is slow",
          "[builds]") {
  fetch_table table{only({}), 1};
  for (const auto* x : {"slow", "fast"}) {
    table.add_source(x);
    table.announce(x, all());
  }
  std::set<size_t> open;
  for (auto asked = table.next(start); !asked.empty();
       asked = table.next(start))
    for (const auto& x : asked) {
      if (x.source == "slow")
        open.insert(x.piece);
      else
        table.take(x);
    }
  CHECK(open.size() == limits::build::questions_of_source);
  CHECK(table.pieces_here() == pieces - open.size());
  const auto slow = start + limits::build::slow;
  CHECK(table.next(slow - std::chrono::milliseconds{1}).empty());
  for (auto asked = table.next(slow); !asked.empty(); asked = table.next(slow))
    for (const auto& x : asked) {
      CHECK(x.source == "fast");
      CHECK(open.count(x.piece) == 1);
      table.take(x);
    }
  CHECK(table.complete());
}

TEST_CASE("a piece that comes twice counts once", "[builds]") {
  auto table = table_with({"a"});
  const auto asked = table.next(start).front();
  CHECK(table.take(asked));
  CHECK_FALSE(table.take(asked));
  CHECK(table.pieces_here() == 1);
}

TEST_CASE("a source that tells of another number of pieces is lost",
          "[builds]") {
  fetch_table table{std::vector<bool>(pieces, false), 1};
  table.add_source("a");
  const size_t wrong = GENERATE(size_t{0}, pieces - 1, pieces + 1);
  table.announce("a", std::vector<bool>(wrong, true));
  CHECK(table.stranded());
}
