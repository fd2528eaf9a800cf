#include "actors/requests/metrics/cell_metrics.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>
#include <vector>

/// What writing the answer of `GET /metrics` takes on the coordinator of a
/// large cell, whose actors have told what they know: the median of the rounds,
/// one JSON line a figure.
namespace {

using namespace roscell;

struct bench_options {
  int nodes = 50;
  int instances = 500;
  int rounds = 101;
};

cell_description make_cell(const bench_options& options) {
  cell_description result;
  result.cell = "line";
  for (int i = 0; i < options.nodes; ++i) {
    registry_row row;
    row.identity.name = "node-" + std::to_string(i);
    row.resources.name = row.identity.name;
    row.resources.cpu = {8, 2.5};
    row.resources.memory_mib = {16384, 3000};
    row.resources.disk_mib = {200000, 120000};
    row.resources.gpus = {{0, "one", {8192, 1000}}};
    result.nodes.push_back(row);
  }
  return result;
}

instance_figures make_figures() {
  instance_figures result;
  result.frames = 100'000;
  result.rate_hz = 30;
  result.dropped = 12;
  result.latency_ms = 4.5;
  result.latency_counts = {900, 8000, 60'000, 25'000, 5000, 900,
                           100, 50,   30,     15,     5};
  result.latency_sum_ms = 512'345.5;
  result.age_ms = 33;
  return result;
}

std::vector<instance_row> make_instances(const bench_options& options) {
  std::vector<instance_row> result;
  for (int i = 0; i < options.instances; ++i) {
    instance_row row;
    row.spec.task = "task-" + std::to_string(i / 5);
    row.spec.step = "step-" + std::to_string(i % 5);
    row.spec.instance = row.spec.task + "-" + row.spec.step + "-0123abcd";
    row.node = "node-" + std::to_string(i % options.nodes);
    row.state = instance_state::running;
    row.figures = make_figures();
    result.push_back(row);
  }
  return result;
}

std::string exposed(const cell_description& cell,
                    const std::vector<instance_row>& instances) {
  exposition text{exposition_format::open_metrics};
  write_cell(cell, text);
  write_instances(instances, text);
  return text.finish();
}

void print(const char* figure, double value, const char* unit) {
  std::cout << R"({"figure":")" << figure << R"(","value":)" << value
            << R"(,"unit":")" << unit << "\"}\n";
}

void measure(const bench_options& options) {
  using namespace std::chrono;
  const auto cell = make_cell(options);
  const auto instances = make_instances(options);
  std::vector<double> ms;
  size_t bytes = 0;
  for (int i = 0; i < options.rounds; ++i) {
    const auto begin = steady_clock::now();
    bytes = exposed(cell, instances).size();
    ms.push_back(
        duration<double, std::milli>(steady_clock::now() - begin).count());
  }
  std::sort(ms.begin(), ms.end());
  print("/metrics written", ms[ms.size() / 2], "ms");
  print("/metrics, longest", ms.back(), "ms");
  print("/metrics, size", static_cast<double>(bytes), "B");
}

} // namespace

int main(int argc, char** argv) {
  bench_options options;
  CLI::App app{"Times the text of GET /metrics."};
  app.add_option("--nodes", options.nodes)->check(CLI::PositiveNumber);
  app.add_option("--instances", options.instances)->check(CLI::PositiveNumber);
  app.add_option("--rounds", options.rounds)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  measure(options);
}
