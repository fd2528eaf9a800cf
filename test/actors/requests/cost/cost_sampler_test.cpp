#include "actors/requests/cost/cost_sampler.hpp"
#include "test/fixture.hpp"

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

/// A node that has used so many seconds of a core.
struct sampler_fixture {
  virtual_time time;
  double cpu_s = 0;
  size_t readings = 0;
  std::shared_ptr<cost_meter> meter = std::make_shared<cost_meter>([this] {
    ++readings;
    return cost_reading{cpu_s, 1000, 0, {}};
  });
  cost_sampler_actor sampler =
      spawn(time.system, time.context, cost_sampler, meter);

  sampler_fixture() {
    time.settle();
  }

  ~sampler_fixture() {
    time.kill(sampler);
  }

  sampler_fixture(const sampler_fixture&) = delete;
  sampler_fixture& operator=(const sampler_fixture&) = delete;

  json state() {
    const auto reply = time.ask<actor_state>(sampler, state_query{});
    time.settle();
    REQUIRE(*reply);
    REQUIRE(**reply);
    return json::parse((**reply)->json_text);
  }

  std::vector<cost_window> windows() {
    return meter->windows(time.scheduler.clock().now());
  }
};

} // namespace

TEST_CASE_METHOD(sampler_fixture,
                 "A node looks at its cost when it starts and once a minute",
                 "[cost]") {
  CHECK(readings == 1);
  CHECK(time.pass(59s) == 0);
  CHECK(readings == 1);
  CHECK(time.pass(1h) == 60);
  CHECK(readings == 61);
  CHECK(state() == json{{"samples", 61}});
}

TEST_CASE_METHOD(sampler_fixture,
                 "Whoever asks gets what the node cost until now", "[cost]") {
  cpu_s = 3;
  time.pass(1min);
  cpu_s = 4;
  time.pass(30s);
  const auto minute = windows().front();
  CHECK(minute.span_s == 90);
  CHECK(minute.cpu_s == 4);
  CHECK(readings == 3);
}

TEST_CASE_METHOD(sampler_fixture,
                 "Questions between two samples do not shorten the hour",
                 "[cost]") {
  for (int i = 0; i < 400; ++i) {
    time.pass(10s);
    windows();
  }
  CHECK(windows()[1].span_s >= 3600);
  CHECK(windows()[1].span_s < 3600 + 600);
}

} // namespace roscell::test
