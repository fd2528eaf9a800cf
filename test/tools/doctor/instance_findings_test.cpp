#include "tools/roscell/doctor/node/node_checks.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell::cli {

using Catch::Contains;

namespace {

instance_row using_of_asked(double memory_mib, double cpu) {
  instance_row row;
  row.spec.instance = "t-a-1";
  row.spec.resources = {0.5, 64, 1};
  row.state = instance_state::running;
  row.metrics.use.memory_mib = memory_mib;
  row.metrics.use.cpu = cpu;
  return row;
}

bool warns_of(const findings& all, const std::string& words) {
  return all.size() == 1 && all[0].how == judgement::warning
         && all[0].seen.find(words) != std::string::npos;
}

} // namespace

TEST_CASE("who takes more than it has asked for is named", "[doctor]") {
  CHECK(judge_use(using_of_asked(60, 0.55)).empty());
  CHECK(judge_use(using_of_asked(-1, -1)).empty());
  CHECK(warns_of(judge_use(using_of_asked(303, 0.1)),
                 "t-a-1 takes 303 MiB of 64 MiB, which it has asked for"));
  CHECK(warns_of(judge_use(using_of_asked(10, 1.5)),
                 "t-a-1 uses 1.5 of 0.5 cores that it has asked for"));
  auto bound = using_of_asked(62, 0.1);
  CHECK(judge_use(bound).empty());
  bound.metrics.use.memory_limit_mib = 64;
  CHECK(warns_of(judge_use(bound), "t-a-1 takes 62 MiB of 64 MiB"));
  bound.metrics.use.memory_mib = 10;
  bound.metrics.use.memory_kills = 2;
  CHECK(warns_of(judge_use(bound), "has lost 2 processes"));
  auto free = using_of_asked(303, 2);
  free.spec.resources = {};
  CHECK(judge_use(free).empty());
}

TEST_CASE("a node whose instances nothing holds to their limits is named",
          "[doctor]") {
  node_description node;
  node.identity.name = "arm";
  node.limits = "cgroup v2 in /sys/fs/cgroup/roscell: cpu, memory, pids";
  CHECK(judge_limits(node).at(0).how == judgement::ok);
  node.limits = "none: it was told so";
  CHECK(warns_of(judge_limits(node),
                 "instances of arm have no limits: it was told so"));
  node.limits.clear();
  CHECK(judge_limits(node).at(0).how == judgement::ok);
}

TEST_CASE("instances that fail, starve or drop frames are told", "[doctor]") {
  instance_row row;
  row.spec.instance = "a-1";
  row.state = instance_state::running;
  row.metrics.frames = 1000;
  row.metrics.dropped = 3;
  CHECK(judge_instances({row})[0].how == judgement::ok);
  row.metrics.dropped = 300;
  CHECK_THAT(judge_instances({row})[0].seen, Contains("dropped 300 frames"));
  row.metrics.remark = "1000 frames in, none out";
  CHECK_THAT(judge_instances({row})[0].seen,
             Contains("gives nothing: 1000 frames in, none out"));
  row.health = instance_health::starved;
  CHECK_THAT(judge_instances({row})[0].seen, Contains("starved"));
  row.unknown_since_unix_ms = 1;
  CHECK(judge_instances({row})[0].how == judgement::warning);
  row.state = instance_state::failed;
  CHECK(judge_instances({row})[0].how == judgement::broken);
}

} // namespace roscell::cli
