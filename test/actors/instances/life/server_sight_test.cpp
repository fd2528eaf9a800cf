#include "actors/instances/life/server_sight.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

const server_sight::time_point at_start{1h};
const std::vector<std::string> both_ends{"a writer of /poses",
                                         "a reader of /image"};

} // namespace

TEST_CASE("what the server has not known for ten seconds is missed, until it "
          "knows it") {
  server_sight sight{false};
  CHECK_FALSE(sight.judge(at_start));
  sight.hear(both_ends, at_start);
  CHECK_FALSE(sight.judge(at_start + 9s));
  CHECK(sight.reason().empty());
  CHECK(sight.judge(at_start + 10s));
  CHECK(sight.reason()
        == "it is not known to its node's discovery server, which has not "
           "seen a writer of /poses, a reader of /image, so that nobody else "
           "hears of it; `roscell topics` and `roscell doctor` look for the "
           "cause");
  // It is said once, also while parts of it come and go.
  sight.hear({both_ends[0]}, at_start + 20s);
  CHECK_FALSE(sight.judge(at_start + 40s));
  sight.hear({}, at_start + 41s);
  CHECK(sight.judge(at_start + 41s));
  CHECK(sight.reason().empty());
}

TEST_CASE("a server that has begun anew has ten seconds to hear of its "
          "programs") {
  server_sight sight{false};
  sight.hear({}, at_start);
  CHECK_FALSE(sight.judge(at_start + 1h));
  sight.hear(both_ends, at_start + 1h);
  sight.hear({both_ends[0]}, at_start + 1h + 3s);
  CHECK_FALSE(sight.judge(at_start + 1h + 9s));
  sight.hear({}, at_start + 1h + 9s);
  CHECK_FALSE(sight.judge(at_start + 2h));
}

TEST_CASE("what was missed before the node began anew is so until it is "
          "known") {
  server_sight sight{true};
  CHECK_FALSE(sight.judge(at_start + 1h));
  sight.hear(both_ends, at_start + 1h);
  CHECK_FALSE(sight.judge(at_start + 1h));
  CHECK_FALSE(sight.judge(at_start + 2h));
  sight.hear({}, at_start + 2h);
  CHECK(sight.judge(at_start + 2h));
}
