#include "control_loop.hpp"
#include "move_to.hpp"

#include <roscell/node.hpp>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

namespace {

/// What the command line says.
struct options {
  roscell::node_setup setup;
  bool with_node = true;
  std::optional<unsigned> loop_core;
  std::optional<unsigned> seconds; ///< None: until SIGINT or SIGTERM.
};

[[noreturn]] void explain() {
  std::cerr
      << "A simulated robot controller with a node inside.\n"
         "robot_controller --data-dir DIR --interface ADDRESS [--name NAME]\n"
         "  [--join HOST[:PORT]] [--coordinator] [--cell NAME] [--shim FILE]\n"
         "  [--site-token FILE] [--port N] [--public-domain N] [--skills DIR]\n"
         "  [--loop-core N] [--node-core N] [--nice N] [--seconds N]\n"
         "  [--without-node]\n";
  std::exit(2);
}

options read_options(int argc, char** argv) {
  options result;
  auto& node = result.setup.node;
  node.name = "arm";
  node.runtime = "process";
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto& word = words[i];
    if (word == "--without-node" || word == "--coordinator") {
      (word == "--coordinator" ? node.coordinator : result.with_node) =
          word == "--coordinator";
      continue;
    }
    if (++i == words.size())
      explain();
    const auto& value = words[i];
    const auto number = [&] {
      return static_cast<unsigned>(std::strtoul(value.c_str(), nullptr, 10));
    };
    if (word == "--data-dir")
      node.data_dir = value;
    else if (word == "--interface")
      node.address = value;
    else if (word == "--name")
      node.name = value;
    else if (word == "--cell")
      node.cell = value;
    else if (word == "--join")
      node.join = value;
    else if (word == "--shim")
      node.shim = value;
    else if (word == "--site-token")
      node.site_token_file = value;
    else if (word == "--skills")
      node.skill_dirs.emplace_back(value);
    else if (word == "--port")
      node.http_port = static_cast<std::uint16_t>(number());
    else if (word == "--public-domain")
      node.public_domain_id = static_cast<std::uint8_t>(number());
    else if (word == "--loop-core")
      result.loop_core = number();
    else if (word == "--node-core")
      result.setup.threads.cpus.push_back(number());
    else if (word == "--nice")
      result.setup.threads.nice = static_cast<int>(number());
    else if (word == "--seconds")
      result.seconds = number();
    else
      explain();
  }
  return result;
}

/// Waits for SIGINT or SIGTERM, or until the time is over.
void wait(const sigset_t& ends, std::optional<unsigned> seconds) {
  if (!seconds) {
    int which = 0;
    ::sigwait(&ends, &which);
    return;
  }
  const timespec span{static_cast<time_t>(*seconds), 0};
  ::sigtimedwait(&ends, nullptr, &span);
}

void show(const jitter& late, bool real_time) {
  using std::chrono::duration_cast;
  std::cout << R"({"median_us":)" << late.quantile(0.5).count()
            << R"(,"p99_9_us":)" << late.quantile(0.999).count()
            << R"(,"worst_us":)"
            << duration_cast<std::chrono::microseconds>(late.worst()).count()
            << R"(,"real_time":)" << (real_time ? "true" : "false") << "}"
            << std::endl;
}

} // namespace

int main(int argc, char** argv) {
  auto wanted = read_options(argc, argv);
  sigset_t ends;
  ::sigemptyset(&ends);
  ::sigaddset(&ends, SIGINT);
  ::sigaddset(&ends, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &ends, nullptr);
  control_loop loop{wanted.loop_core};
  wanted.setup.skills.push_back(make_move_to(loop));
  try {
    std::optional<roscell::embedded_node> node;
    if (wanted.with_node) {
      node.emplace(wanted.setup);
      std::cerr << "node '" << node->facts().name << "' listens on "
                << node->facts().http_address << " and " << node->facts().socket
                << std::endl;
    }
    wait(ends, wanted.seconds);
  } catch (const roscell::node_error& error) {
    std::cerr << "robot_controller: " << error.what()
              << (error.hint().empty() ? "" : "; ") << error.hint()
              << std::endl;
    return 1;
  }
  const auto at = loop.wrist();
  std::cerr << "the wrist is at " << at.x << " " << at.y << " " << at.z << " m"
            << std::endl;
  show(loop.stop(), loop.is_real_time());
  return 0;
}
