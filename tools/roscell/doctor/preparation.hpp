#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// What `roscell doctor` looks at.
namespace roscell::cli {

struct doctor_options {
  connection_options connection;
  std::string output = "table";
  std::filesystem::path config;
  std::string interface;
  std::filesystem::path data_dir;
  std::vector<std::string> only;
  bool list = false;
  bool cell = false;
};

/// The command that looks at the same again.
std::string command_of(const doctor_options& options);

/// What is looked at, and by what.
struct check_plan {
  checked_host host;
  std::vector<check> checks;
  findings known; ///< Found while it was prepared.
  std::shared_ptr<const node_client> node;
  std::string own; ///< Name of the node that runs here; empty: none does.
};

/// Asks the node that runs here, or was named, whether it is there.
check_plan prepare(const doctor_options& options);

/// Leaves out what was not asked for. A node that was named and does not answer
/// stays.
void keep_only(const std::vector<std::string>& names, bool cell,
               check_plan& what);

} // namespace roscell::cli
