#include "actors/edge/dds/discovery_setup.hpp"
#include "actors/edge/host/own_process.hpp"
#include "tools/roscell/config/node_source.hpp"
#include "tools/roscell/daemon/node_address.hpp"
#include "tools/roscell/daemon/node_process.hpp"

#include <malloc.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>

namespace roscell::cli {

namespace {

/// Small memory counts more than fast allocation on a robot: threads share
/// one arena, and freed memory goes back to the system early.
void save_memory() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TRIM_THRESHOLD, 64 * 1024);
  mallopt(M_MMAP_THRESHOLD, 64 * 1024);
}

void set_up_log(const node_options& options) {
  auto log = spdlog::stderr_logger_mt("roscell");
  log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  log->set_level(spdlog::level::from_str(options.log_level));
  log->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(log);
}

} // namespace

int run_node(const node_source& source) {
  prepare_dds_environment();
  save_memory();
  raise_descriptor_limit();
  std::signal(SIGPIPE, SIG_IGN);
  // Threads inherit the signals that it blocks, so it comes before all of them.
  const auto started = source.read();
  const auto& options = started.options;
  node_process process{source, started, choose_interface(options.interface)};
  set_up_log(options);
  return process.run();
}

} // namespace roscell::cli
