#include "actors/cell/limits.hpp"
#include "actors/requests/limits.hpp"
#include "actors/requests/metrics/scrape.hpp"

#include "actors/core/limits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <string>

namespace roscell::test {

namespace {

/// Keeps the answer that it is given.
struct kept_answer : reply_sink {
  std::string text;

  void reply(http_reply reply) override {
    text = reply.body;
  }

  std::shared_ptr<http_stream> stream(std::string) override {
    return nullptr;
  }
};

/// A coordinator whose node `arm` runs a skill that tells metrics.
struct scraped_cell : paper_cell {
  fake_agent& arm;
  instance_row& row;
  std::shared_ptr<ros_graph> graph;

  scraped_cell()
      : arm(add("arm")),
        row((request(echo_task("t", {echo_step("s0", 1, "arm")})),
             arm.running.begin()->second)) {
    row.metrics.frames = 120;
  }

  std::shared_ptr<kept_answer> scrape() {
    auto services = std::make_shared<node_services>();
    services->context = context;
    services->coordinator = coordinator;
    services->graph = graph;
    auto result = std::make_shared<kept_answer>();
    start_scrape(time.system, services, responder{result},
                 exposition_format::text);
    time.settle();
    return result;
  }

  /// What a scraper has that does not wait for arm.
  std::string scrape_muted() {
    arm.mute = true;
    const auto answer = scrape();
    CHECK(answer->text.empty());
    time.advance(limits::resource::scrape_collection);
    return answer->text;
  }
};

bool has_frames(const std::string& text, int frames) {
  return text.find("roscell_instance_frames_total{instance_id=\"t-s0-")
             != std::string::npos
         && text.find("node=\"arm\"} " + std::to_string(frames) + "\n")
                != std::string::npos;
}

} // namespace

TEST_CASE_METHOD(scraped_cell, "a scraper gets what nodes tell at once",
                 "[metrics]") {
  const auto text = scrape()->text;
  CHECK(has_frames(text, 120));
  CHECK(text.find("roscell_node_state{node=\"arm\",state=\"active\"} 1\n")
        != std::string::npos);
  CHECK(text.find("roscell_tasks{state=\"running\"} 1\n") != std::string::npos);
}

TEST_CASE_METHOD(scraped_cell,
                 "a scraper gets whom the node's discovery server knows",
                 "[metrics]") {
  const auto family = "roscell_discovery_participants";
  CHECK(scrape()->text.find(family) == std::string::npos);
  graph = std::make_shared<ros_graph>();
  graph->name_participant(server_prefix(3), "roscell");
  graph->name_participant(guid_prefix{1}, "/echo");
  graph->name_participant(guid_prefix{2}, "/say");
  const auto text = scrape()->text;
  CHECK(text.find(std::string{family} + "{kind=\"server\"} 1\n")
        != std::string::npos);
  CHECK(text.find(std::string{family} + "{kind=\"program\"} 2\n")
        != std::string::npos);
}

TEST_CASE_METHOD(scraped_cell,
                 "what a node tells too late is in the next scrape",
                 "[metrics]") {
  scrape();
  row.metrics.frames = 150;
  CHECK(has_frames(scrape_muted(), 120));
  arm.report_metrics();
  time.settle();
  CHECK(has_frames(scrape_muted(), 150));
}

TEST_CASE_METHOD(scraped_cell,
                 "metrics of a node that stays silent are not told any more",
                 "[metrics]") {
  scrape();
  CHECK(has_frames(scrape_muted(), 120));
  time.advance(limits::resource::collection);
  CHECK_FALSE(has_frames(scrape_muted(), 120));
}

TEST_CASE_METHOD(scraped_cell, "a node that is away has no metrics",
                 "[metrics]") {
  scrape();
  lose(arm);
  const auto text = scrape()->text;
  CHECK_FALSE(has_frames(text, 120));
  CHECK(text.find("roscell_instance_state{instance_id=\"t-s0-")
        != std::string::npos);
  CHECK(text.find("roscell_tasks{state=\"degraded\"} 1\n")
        != std::string::npos);
}

TEST_CASE_METHOD(scraped_cell,
                 "a name that goes to another machine is told once",
                 "[metrics]") {
  lose(arm);
  time.advance(limits::membership::name_held + std::chrono::seconds{1});
  auto kept = time.ask<place_reserved>(
      coordinator, place_reservation{"arm", "a-new-machine", 1, 60'000});
  time.settle();
  REQUIRE(kept->has_value());
  const auto text = scrape()->text;
  const auto count = [&text](const std::string& words) {
    size_t result = 0;
    for (auto at = text.find(words); at != std::string::npos;
         at = text.find(words, at + 1))
      ++result;
    return result;
  };
  CHECK(count("roscell_node_state{node=\"arm\"") == 1);
  CHECK(count("roscell_node_resource_used{node=\"arm\",resource=\"cpu_cores\"")
        == 1);
  CHECK(count("roscell_instance_state{instance_id=\"t-s0-") == 1);
}

} // namespace roscell::test
