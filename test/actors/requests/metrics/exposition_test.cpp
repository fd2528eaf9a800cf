#include "actors/requests/metrics/cell_metrics.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

std::string counted(exposition_format format) {
  exposition text{format};
  text.counter("roscell_x", "Things.");
  text.sample({{"name", "a\"b\\c\nd"}}, 2);
  return text.finish();
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

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
  metric_book book;
  for (const double x : {1.0, 1.0, 100.0, 1e9})
    book.observe(metric::allocation_states, {}, x);
  exposition text{exposition_format::text};
  text.write(metric::allocation_states, book);
  const auto whole = text.finish();
  CHECK(has(whole, "roscell_allocation_states_bucket{le=\"1\"} 2\n"));
  CHECK(has(whole, "roscell_allocation_states_bucket{le=\"100\"} 3\n"));
  CHECK(has(whole, "roscell_allocation_states_bucket{le=\"+Inf\"} 4\n"));
  CHECK(has(whole, "roscell_allocation_states_count 4\n"));
}

TEST_CASE("what nobody knows of an instance is left out", "[metrics]") {
  instance_row row;
  row.spec.instance = "t-a-1";
  row.state = instance_state::running;
  row.restarts = 3;
  exposition text{exposition_format::text};
  write_instances({row}, text);
  const auto whole = text.finish();
  CHECK(has(whole, "state=\"running\"} 1\n"));
  CHECK(has(whole, "roscell_instance_restarts_total{instance_id=\"t-a-1\""));
  CHECK_FALSE(has(whole, "roscell_instance_frames_total{"));
}

TEST_CASE("a node's resources are told in base units", "[metrics]") {
  cell_description cell;
  cell.nodes.emplace_back();
  cell.nodes[0].identity.name = "arm";
  cell.nodes[0].state = row_state::active;
  cell.nodes[0].resources.memory_mib = {2, 1};
  exposition text{exposition_format::text};
  write_cell(cell, text);
  const auto whole = text.finish();
  CHECK(has(whole, "roscell_node_resource_capacity{node=\"arm\","
                   "resource=\"memory_bytes\"} 2097152\n"));
  CHECK(has(whole, "roscell_node_state{node=\"arm\",state=\"active\"} 1\n"));
  CHECK(has(whole, "roscell_tasks{state=\"running\"} 0\n"));
}

} // namespace roscell::test
