#include "actors/requests/metrics/scrape.hpp"

#include "test/words.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

std::string counted(exposition_format format) {
  exposition text{format};
  text.counter("roscell_x", "Things.");
  text.sample({{"name", "a\"b\\c\nd"}}, 2);
  return text.finish();
}

using roscell::test::has;

} // namespace

TEST_CASE("a counter is named as its format wants it", "[metrics]") {
  const auto sample =
      std::string{"roscell_x_total{name=\"a\\\"b\\\\c\\nd\"} 2\n"};
  CHECK(counted(exposition_format::text)
        == "# HELP roscell_x_total Things.\n# TYPE roscell_x_total counter\n"
               + sample);
  CHECK(counted(exposition_format::open_metrics)
        == "# HELP roscell_x Things.\n# TYPE roscell_x counter\n" + sample
               + "# EOF\n");
}

TEST_CASE("who asks for OpenMetrics gets it", "[metrics]") {
  CHECK(format_for("application/openmetrics-text;version=1.0.0,*/*;q=0.1")
        == exposition_format::open_metrics);
  CHECK(format_for("") == exposition_format::text);
  CHECK(format_for("text/plain") == exposition_format::text);
}

TEST_CASE("a histogram's buckets include the smaller ones", "[metrics]") {
  metric_table table;
  for (const double x : {1.0, 1.0, 100.0, 1e9})
    table.observe(metric::allocation_states, {}, x);
  exposition text{exposition_format::text};
  text.write(metric::allocation_states, table);
  const auto whole = text.finish();
  CHECK(has(whole, "roscell_allocation_states_bucket{le=\"1\"} 2\n"));
  CHECK(has(whole, "roscell_allocation_states_bucket{le=\"100\"} 3\n"));
  CHECK(has(whole, "roscell_allocation_states_bucket{le=\"+Inf\"} 4\n"));
  CHECK(has(whole, "roscell_allocation_states_count 4\n"));
}

TEST_CASE("a bound is written as all who expose one write it", "[metrics]") {
  const std::vector<double> bounds{0.0001, 0.5, 1, 100'000, 1'000'000};
  const auto written = [&](exposition_format format) {
    exposition text{format};
    text.histogram("roscell_x_seconds", "Times.", bounds);
    text.buckets({{"a", "b"}}, {1, 1, 1, 1, 1, 1}, 2.5);
    return text.finish();
  };
  const auto older = written(exposition_format::text);
  CHECK(has(older, "# TYPE roscell_x_seconds histogram\n"));
  for (const auto* bound : {"0.0001", "0.5", "1", "100000", "1e+06", "+Inf"})
    CHECK(has(older, ",le=\"" + std::string{bound} + "\"} "));
  CHECK(has(older, "roscell_x_seconds_sum{a=\"b\"} 2.5\n"));
  const auto open = written(exposition_format::open_metrics);
  for (const auto* bound :
       {"0.0001", "0.5", "1.0", "100000.0", "1e+06", "+Inf"})
    CHECK(has(open, ",le=\"" + std::string{bound} + "\"} "));
}

TEST_CASE("an instance's times are a histogram in seconds", "[metrics]") {
  instance_measures row;
  row.instance = "t-a-1";
  row.task = "t";
  row.step = "a";
  row.node = "arm";
  row.metrics.latency_counts = {1, 2, 0, 4, 0, 0, 3, 0, 0, 1, 1};
  row.metrics.latency_sum_ms = 2500;
  auto silent = row;
  silent.instance = "t-a-2";
  silent.metrics = {};
  auto half = row;
  half.instance = "t-a-3";
  half.metrics.latency_sum_ms = -1;
  exposition text{exposition_format::text};
  write_instances({row, silent, half}, text);
  const auto whole = text.finish();
  const std::string family = "roscell_instance_latency_seconds";
  const std::string of = R"({instance_id="t-a-1",task="t",step="a",node="arm")";
  CHECK(has(whole, "# TYPE " + family + " histogram\n"));
  for (const auto* end :
       {R"(0.001"} 1)", R"(0.002"} 3)", R"(0.005"} 3)", R"(0.01"} 7)",
        R"(0.02"} 7)", R"(0.05"} 7)", R"(0.1"} 10)", R"(0.2"} 10)",
        R"(0.5"} 10)", R"(1"} 11)", R"(+Inf"} 12)"})
    CHECK(has(whole, family + "_bucket" + of + ",le=\"" + end + "\n"));
  CHECK(has(whole, family + "_count" + of + "} 12\n"));
  CHECK(has(whole, family + "_sum" + of + "} 2.5\n"));
  for (const auto* other : {"t-a-2", "t-a-3"})
    CHECK_FALSE(has(whole, family + "_count{instance_id=\"" + other));
}

TEST_CASE("what nobody knows of an instance is left out", "[metrics]") {
  instance_measures row;
  row.instance = "t-a-1";
  row.state = instance_state::running;
  row.restarts = 3;
  exposition text{exposition_format::text};
  write_instances({row}, text);
  const auto whole = text.finish();
  CHECK(has(whole, "state=\"running\"} 1\n"));
  CHECK(has(whole, "roscell_instance_starved{instance_id=\"t-a-1\""));
  CHECK_FALSE(has(whole, "roscell_instance_failed_frames_total{"));
  CHECK(has(whole, "roscell_instance_restarts_total{instance_id=\"t-a-1\""));
  CHECK_FALSE(has(whole, "roscell_instance_frames_total{"));
}

TEST_CASE("a node's resources are told in base units", "[metrics]") {
  cell_measured cell;
  cell.tasks = {{task_state::running, 2}, {task_state::failed, 0}};
  cell.nodes.emplace_back();
  cell.nodes[0].resources.name = "arm";
  cell.nodes[0].state = row_state::active;
  cell.nodes[0].resources.memory_mib = {2, 1};
  exposition text{exposition_format::text};
  write_cell(cell, text);
  const auto whole = text.finish();
  CHECK(has(whole, "roscell_node_resource_capacity{node=\"arm\","
                   "resource=\"memory_bytes\"} 2097152\n"));
  CHECK(has(whole, "roscell_node_state{node=\"arm\",state=\"active\"} 1\n"));
  CHECK(has(whole, "roscell_tasks{state=\"running\"} 2\n"));
  CHECK(has(whole, "roscell_tasks{state=\"failed\"} 0\n"));
}

} // namespace roscell::test
