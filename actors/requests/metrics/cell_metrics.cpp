#include "actors/requests/metrics/scrape.hpp"

#include "actors/core/program_version.hpp"

#include <string>
#include <string_view>

namespace roscell {

namespace {

constexpr double mib = 1024 * 1024;
constexpr double ms_in_s = 1000;

/// One resource of one node, in base units.
struct resource_line {
  std::string node;
  std::string resource;
  double capacity = 0;
  double used = 0;
};

template <class Enum>
std::string_view word_of(Enum value) {
  return enum_words(value)[static_cast<size_t>(value)];
}

std::vector<resource_line> lines_of(const std::string& node,
                                    const node_resources& x) {
  std::vector<resource_line> result{
      {node, "cpu_cores", x.cpu.capacity, x.cpu.used},
      {node, "memory_bytes", x.memory_mib.capacity * mib,
       x.memory_mib.used * mib},
      {node, "disk_bytes", x.disk_mib.capacity * mib, x.disk_mib.used * mib}};
  for (const auto& gpu : x.gpus)
    result.push_back({node, "gpu_" + std::to_string(gpu.index) + "_bytes",
                      gpu.memory_mib.capacity * mib,
                      gpu.memory_mib.used * mib});
  return result;
}

void write_resources(const std::vector<resource_line>& lines, exposition& to) {
  to.gauge("roscell_node_resource_capacity",
           "What a node offers, in the unit that the resource names.");
  for (const auto& x : lines)
    to.sample({{"node", x.node}, {"resource", x.resource}}, x.capacity);
  to.gauge("roscell_node_resource_used",
           "What is in use or reserved of it, as last reported.");
  for (const auto& x : lines)
    to.sample({{"node", x.node}, {"resource", x.resource}}, x.used);
}

/// An instance and its labels, which every family has.
struct labelled_instance {
  const instance_measures* row;
  sample_labels labels;
};

std::vector<labelled_instance>
labelled(const std::vector<instance_measures>& rows) {
  std::vector<labelled_instance> result;
  result.reserve(rows.size());
  for (const auto& x : rows)
    result.push_back({&x,
                      {{"instance_id", x.instance},
                       {"task", x.task},
                       {"step", x.step},
                       {"node", x.node}}});
  return result;
}

/// One gauge or counter of all instances; a negative value is not known.
template <class Value>
void write_each(const std::vector<labelled_instance>& rows, exposition& to,
                Value&& value_of) {
  for (const auto& x : rows)
    if (const double value = value_of(*x.row); value >= 0)
      to.sample(x.labels, value);
}

void write_states(const std::vector<labelled_instance>& rows, exposition& to) {
  to.gauge("roscell_instance_state", "1 for the state an instance is in.");
  for (const auto& x : rows) {
    auto labels = x.labels;
    labels.add("state", word_of(x.row->state));
    to.sample(labels, 1);
  }
}

void write_starved(const std::vector<labelled_instance>& rows, exposition& to) {
  to.gauge("roscell_instance_starved",
           "1 if an input gets too little, or nothing of what is sent.");
  write_each(rows, to, [](const auto& x) {
    if (x.state != instance_state::running)
      return -1;
    return x.health == instance_health::starved ? 1 : 0;
  });
}

void write_inputs(const std::vector<labelled_instance>& rows, exposition& to) {
  to.counter("roscell_instance_failed_frames",
             "Frames at which its skill has failed, of all inputs.");
  write_each(rows, to, [](const auto& x) {
    int64_t failed = x.metrics.streams.empty() ? -1 : 0;
    for (const auto& stream : x.metrics.streams)
      failed += stream.failed;
    return static_cast<double>(failed);
  });
}

void write_latencies(const std::vector<labelled_instance>& rows,
                     exposition& to) {
  std::vector<double> bounds_s;
  bounds_s.reserve(latency_bounds_ms.size());
  for (const auto bound_ms : latency_bounds_ms)
    bounds_s.push_back(bound_ms / ms_in_s);
  to.histogram("roscell_instance_latency_seconds",
               "Time in which its skill processes a frame.", bounds_s);
  for (const auto& x : rows) {
    const auto& counts = x.row->metrics.latency_counts;
    const auto sum_ms = x.row->metrics.latency_sum_ms;
    if (counts.size() == bounds_s.size() + 1 && sum_ms >= 0)
      to.buckets(x.labels, {counts.begin(), counts.end()}, sum_ms / ms_in_s);
  }
}

void write_use(const std::vector<labelled_instance>& rows, exposition& to) {
  to.gauge("roscell_instance_memory_bytes",
           "Memory that it takes, without what the kernel can drop.");
  write_each(rows, to,
             [](const auto& x) { return x.metrics.use.memory_mib * mib; });
  to.gauge("roscell_instance_memory_limit_bytes",
           "More memory the kernel does not give it.");
  write_each(rows, to, [](const auto& x) {
    return x.metrics.use.memory_limit_mib * mib;
  });
  to.counter("roscell_instance_cpu_seconds",
             "CPU time since its program was started.");
  write_each(rows, to, [](const auto& x) { return x.metrics.use.cpu_s; });
  to.counter("roscell_instance_memory_kills",
             "Processes of it that the kernel has ended for memory.");
  write_each(rows, to, [](const auto& x) {
    const auto& use = x.metrics.use;
    return use.memory_mib < 0 ? -1.0 : static_cast<double>(use.memory_kills);
  });
}

} // namespace

void write_cost(const own_cost& cost, double booted_unix_s, exposition& to) {
  to.gauge("roscell_build_info", "The version of the program.");
  to.sample({{"version", program_version}}, 1);
  to.counter("process_cpu_seconds", "CPU time of the node's own process.");
  to.sample({}, cost.cpu_seconds);
  to.gauge("process_resident_memory_bytes", "Resident memory of it.");
  to.sample({}, cost.resident_bytes);
  to.gauge("roscell_process_pss_bytes",
           "The same, with shared pages divided among those who share them.");
  to.sample({}, cost.pss_bytes);
  to.gauge("process_open_fds", "Its open files.");
  to.sample({}, cost.open_files);
  to.gauge("process_start_time_seconds", "When it was started, in Unix time.");
  to.sample({}, booted_unix_s + cost.started_s);
  to.counter("roscell_process_written_bytes", "What it has written to disks.");
  to.sample({}, cost.written_bytes);
}

void write_participants(const participant_counts& known, exposition& to) {
  to.gauge("roscell_discovery_participants",
           "DDS participants that the node's discovery server knows.");
  to.sample({{"kind", "program"}}, static_cast<double>(known.programs));
  to.sample({{"kind", "server"}}, static_cast<double>(known.servers));
}

void write_cell(const cell_measured& cell, exposition& to) {
  std::vector<resource_line> lines;
  to.gauge("roscell_node_state", "1 for the state in which a node is.");
  for (const auto& x : cell.nodes) {
    to.sample({{"node", x.resources.name}, {"state", word_of(x.state)}}, 1);
    for (auto& line : lines_of(x.resources.name, x.resources))
      lines.push_back(std::move(line));
  }
  write_resources(lines, to);
  to.gauge("roscell_tasks", "Tasks of the cell, by their state.");
  for (const auto& x : cell.tasks)
    to.sample({{"state", word_of(x.state)}}, static_cast<double>(x.tasks));
}

void write_node(const node_resources& node, exposition& to) {
  write_resources(lines_of(node.name, node), to);
}

void write_instances(const std::vector<instance_measures>& instances,
                     exposition& to) {
  const auto rows = labelled(instances);
  write_states(rows, to);
  write_starved(rows, to);
  to.counter("roscell_instance_restarts",
             "How often its node has started it again.");
  write_each(rows, to,
             [](const auto& x) { return static_cast<double>(x.restarts); });
  to.counter("roscell_instance_frames", "Frames that its skill has processed.");
  write_each(rows, to, [](const auto& x) {
    return static_cast<double>(x.metrics.frames);
  });
  to.counter("roscell_instance_dropped_frames",
             "Frames that came too fast for it.");
  write_each(rows, to, [](const auto& x) {
    return static_cast<double>(x.metrics.dropped);
  });
  write_inputs(rows, to);
  to.gauge("roscell_instance_median_latency_seconds",
           "Median time in which its skill processes a frame.");
  write_each(rows, to,
             [](const auto& x) { return x.metrics.latency_ms / ms_in_s; });
  write_latencies(rows, to);
  to.gauge(
      "roscell_instance_median_age_seconds",
      "Median time from a frame's stamp to the output of what came of it.");
  write_each(rows, to,
             [](const auto& x) { return x.metrics.age_ms / ms_in_s; });
  write_use(rows, to);
}

} // namespace roscell
