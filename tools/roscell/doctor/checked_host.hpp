#pragma once

#include "roscell/node_config.hpp"

#include <string>

namespace roscell::cli {

/// Which host is looked at, and with which node in mind. The paths and commands
/// are there so that a test can show another host.
struct checked_host {
  node_config config;     ///< Of the node that runs here, or would.
  std::string interface;  ///< Name or address; empty: the first of hardware.
  bool node_runs = false; ///< The ports of `config` are in use by it.
  std::string proc = "/proc";
  std::string dev = "/dev";
  std::string sys = "/sys";
  std::string nft = "nft";
  std::string nvml = "libnvidia-ml.so.1";
};

} // namespace roscell::cli
