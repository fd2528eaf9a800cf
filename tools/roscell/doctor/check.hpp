#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/insight/examination.hpp"
#include "roscell/node_config.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

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

/// "ok", "skipped", "warning", "broken".
const char* to_word(judgement how);

/// A finding that no check of `run_checks` has made.
/// @param area "network", "host", "node" or "cell".
finding named_finding(std::string check, const char* area, finding x);

/// Whether one of them is broken.
bool is_broken(const findings& all);

/// [{"check", "area", "node", "verdict", "seen", "matters", "remedy"}, ...];
/// what is empty is left out.
json to_json_list(const findings& all);

/// Something that can be looked at by itself.
struct check {
  const char* name;
  const char* area;  ///< "network", "host" or "node".
  const char* about; ///< What it looks at.
  std::function<findings(const checked_host&)> run_check;
};

/// The longest that a check is waited for.
constexpr std::chrono::seconds longest_check{10};

/// Told the checks that still look, when it has taken so long that somebody may
/// wonder.
using still_checking = std::function<void(const std::vector<std::string>&)>;

/// Makes all checks at once, and gives what they found in the order of the
/// checks. One that does not end, on a disk that does not answer, say, is a
/// finding itself, and is left to itself; until it ends it is not begun again.
findings run_checks(const std::vector<check>& checks, const checked_host& host,
                    const still_checking& report_progress,
                    std::chrono::milliseconds limit = longest_check);

/// What a host can see by itself.
const std::vector<check>& host_checks();

/// What a node that runs here finds on its host.
/// @param config as the node was started with, its address included.
findings check_own_host(const node_config& config);

} // namespace roscell::cli
