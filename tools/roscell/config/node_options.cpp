#include "tools/roscell/config/node_options.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace roscell::cli {

namespace {

/// The bytes that an option says, within its bounds.
uint64_t bytes_of(const std::string& option, const std::string& text,
                  const std::string& least, const std::string& most) {
  uint64_t bytes = 0;
  try {
    bytes = parse_bytes(text);
  } catch (const std::invalid_argument& e) {
    throw command_error{exit_usage, option + ": " + e.what()};
  }
  if (bytes < parse_bytes(least) || bytes > parse_bytes(most))
    throw command_error{exit_usage,
                        option + ": not between " + least + " and " + most};
  return bytes;
}

std::chrono::seconds history_age(const std::string& text) {
  constexpr std::chrono::hours least{1};
  try {
    if (const auto result = parse_span(text); result >= least)
      return result;
  } catch (const std::invalid_argument& e) {
    throw command_error{exit_usage, "--history-age: " + std::string{e.what()}};
  }
  throw command_error{exit_usage, "--history-age: less than an hour",
                      "the bound in bytes is --history-bytes"};
}

void add_label(std::map<std::string, std::string>& labels,
               const std::string& text) {
  const auto equals = text.find('=');
  if (equals == text.npos || equals == 0)
    throw command_error{exit_usage, "--label: '" + text + "' is not KEY=VALUE"};
  const auto key = text.substr(0, equals);
  if (!labels.emplace(key, text.substr(equals + 1)).second)
    throw command_error{exit_usage, "--label: '" + key + "' is given twice"};
}

/// Steps that ask for a device must find it where its node is.
void check_device(const std::string& path) {
  std::error_code problem;
  const auto found = std::filesystem::status(path, problem);
  if (found.type() == std::filesystem::file_type::not_found)
    throw command_error{exit_usage, "--device: there is no '" + path + "'",
                        "plug it in, or leave the option out"};
  if (problem)
    throw command_error{exit_usage,
                        "--device: '" + path + "': " + problem.message()};
  if (!is_character_file(found) && !is_block_file(found))
    throw command_error{exit_usage, "--device: '" + path + "' is no device",
                        "name a device node such as /dev/video0"};
}

/// What only a coordinator can be asked for.
void check_cell_options(const node_config& config) {
  if (config.coordinator)
    return;
  if (!config.cell.empty())
    throw command_error{exit_usage, "--cell names the cell of a coordinator",
                        "add --coordinator, or --join the cell"};
  if (config.force)
    throw command_error{exit_usage, "--force takes a coordinator's cell name",
                        "add --coordinator, or leave out --force"};
  if (!config.rebalance)
    throw command_error{exit_usage,
                        "--no-rebalance is for a coordinator's cell",
                        "add --coordinator, or leave out --no-rebalance"};
  if (config.ros2_set_parameters)
    throw command_error{exit_usage,
                        "--ros2-set-parameters is for a coordinator's cell",
                        "give it to the coordinator, and leave it out here"};
  if (config.require_signed_skills)
    throw command_error{exit_usage,
                        "--require-signed-skills is for a coordinator's cell",
                        "give it to the coordinator, and leave it out here"};
}

/// The ways to come into a cell exclude each other.
void check_ways_to_join(const node_config& config) {
  if (!config.join.empty() && config.coordinator)
    throw command_error{exit_usage,
                        "a coordinator has its own cell and joins none",
                        "leave out --join or --coordinator"};
  if (config.wait && config.coordinator)
    throw command_error{exit_usage,
                        "a coordinator has its own cell and waits for none",
                        "leave out --wait or --coordinator"};
  if (config.wait && !config.join.empty())
    throw command_error{exit_usage,
                        "--join goes to a cell, --wait waits to be chosen",
                        "leave out one of them"};
}

void check_addresses(const node_config& config) {
  for (const auto& peer : config.peers)
    if (!parse_host_address(peer, 1))
      throw command_error{exit_usage,
                          "--peer: '" + peer
                              + "' is not HOST[:PORT] with an IPv4 address "
                                "or a name",
                          "such as 192.168.1.10 or base.local"};
}

} // namespace

node_config to_config(const node_options& options) {
  auto config = options.config;
  check_cell_options(config);
  check_ways_to_join(config);
  check_addresses(config);
  for (const auto& device : config.devices)
    check_device(device);
  if (config.data_dir.empty())
    config.data_dir = default_data_dir();
  // Children run elsewhere, so nothing may depend on where we were started.
  config.data_dir = std::filesystem::absolute(config.data_dir);
  for (const auto& dir : options.skill_dirs)
    config.skill_dirs.push_back(std::filesystem::absolute(dir));
  if (!config.registry_auth.empty())
    config.registry_auth = std::filesystem::absolute(config.registry_auth);
  if (config.socket.empty())
    config.socket = config.data_dir / "node.sock";
  config.socket = std::filesystem::absolute(config.socket);
  for (const auto& label : options.labels)
    add_label(config.labels, label);
  config.log_bytes = bytes_of("--log-bytes", options.log_bytes, "4KiB", "1GiB");
  config.history_bytes =
      bytes_of("--history-bytes", options.history_bytes, "2MiB", "1024GiB");
  config.builds_bytes =
      bytes_of("--builds-bytes", options.builds_bytes, "1MiB", "1024GiB");
  config.history_age = history_age(options.history_age);
  return config;
}

} // namespace roscell::cli
