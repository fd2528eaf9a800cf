#include "tools/roscell/doctor/check.hpp"

#include "tools/roscell/doctor/host/dds_files.hpp"
#include "tools/roscell/doctor/host/disk.hpp"
#include "tools/roscell/doctor/host/gpu.hpp"
#include "tools/roscell/doctor/host/kernel.hpp"
#include "tools/roscell/doctor/host/programs.hpp"
#include "tools/roscell/doctor/host/rights.hpp"
#include "tools/roscell/doctor/host/shared_memory.hpp"
#include "tools/roscell/doctor/network/addresses.hpp"
#include "tools/roscell/doctor/network/buffers.hpp"
#include "tools/roscell/doctor/network/firewall.hpp"
#include "tools/roscell/doctor/network/ports.hpp"
#include "tools/roscell/doctor/node/own_node.hpp"

#include <algorithm>
#include <exception>
#include <future>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace roscell::cli {

namespace {

using deadline_clock = std::chrono::steady_clock;

/// What takes longer than this is told about.
constexpr std::chrono::seconds check_patience{1};

using check_result = std::shared_future<findings>;

/// The checks that were left to themselves and may still be going on. A node is
/// asked to look again and again: what hangs must not take a thread each time.
class abandoned_checks {
public:
  void add(const std::string& name, check_result run_check) {
    const std::lock_guard lock{mutex_};
    checks_[name] = std::move(run_check);
  }

  /// Not valid if none of that name goes on.
  check_result find(const std::string& name) {
    const std::lock_guard lock{mutex_};
    const auto i = checks_.find(name);
    if (i == checks_.end())
      return {};
    if (i->second.wait_for(std::chrono::seconds{0})
        != std::future_status::ready)
      return i->second;
    checks_.erase(i);
    return {};
  }

private:
  std::mutex mutex_;
  std::map<std::string, check_result> checks_;
};

/// For as long as the program runs, as the threads do.
abandoned_checks& left_of_program() {
  static auto* all = new abandoned_checks;
  return *all;
}

/// A check that is being made, by a thread of its own, which may stay in the
/// kernel for ever.
class running_check {
public:
  running_check(const check& what, const checked_host& host)
      : what_{what}, result_{left_of_program().find(what.name)} {
    if (result_.valid())
      return;
    std::packaged_task<findings()> task{
        [run_check = what.run_check, host] { return run_check(host); }};
    result_ = task.get_future();
    try {
      thread_ = std::thread{std::move(task)};
    } catch (const std::system_error& e) {
      not_begun_ = e.what();
    }
  }

  bool ends_until(deadline_clock::time_point deadline) const {
    return result_.wait_until(deadline) == std::future_status::ready;
  }

  const check& what() const {
    return what_;
  }

  /// To be called once.
  findings end(deadline_clock::time_point deadline) {
    const bool ended = ends_until(deadline);
    if (!ended && thread_.joinable()) {
      left_of_program().add(what_.name, result_);
      thread_.detach();
    } else if (thread_.joinable()) {
      thread_.join();
    }
    auto result = ended ? found() : findings{unended()};
    for (auto& x : result) {
      x.check = what_.name;
      x.area = what_.area;
    }
    return result;
  }

private:
  finding unended() const {
    return {judgement::broken, "it did not end in time",
            "what it checks does not answer: a disk, a driver or a "
            "container engine that hangs",
            "roscell doctor --only " + std::string{what_.name}};
  }

  findings found() const {
    if (!not_begun_.empty())
      return {{judgement::skipped, "it could not be begun: " + not_begun_}};
    try {
      return result_.get();
    } catch (const std::exception& e) {
      return {{judgement::skipped, std::string{"it failed: "} + e.what()}};
    }
  }

  const check& what_;
  check_result result_;
  std::thread thread_;
  std::string not_begun_; ///< Why there is no thread.
};

} // namespace

const char* to_word(judgement how) {
  return enum_words(how)[static_cast<size_t>(how)].data();
}

finding named_finding(std::string check, const char* area, finding x) {
  x.check = std::move(check);
  x.area = area;
  return x;
}

bool is_broken(const findings& all) {
  return std::any_of(all.begin(), all.end(),
                     [](auto& x) { return x.how == judgement::broken; });
}

json to_json_list(const findings& all) {
  auto result = json::array();
  for (const auto& x : all)
    result.push_back(x);
  return result;
}

findings run_checks(const std::vector<check>& checks, const checked_host& host,
                    const still_checking& report_progress,
                    std::chrono::milliseconds limit) {
  const auto begin = deadline_clock::now();
  const auto early =
      begin + std::min<deadline_clock::duration>(check_patience, limit);
  std::vector<running_check> looks;
  looks.reserve(checks.size());
  for (const auto& x : checks)
    looks.emplace_back(x, host);
  std::vector<std::string> waiting;
  for (const auto& x : looks)
    if (!x.ends_until(early))
      waiting.emplace_back(x.what().name);
  if (!waiting.empty())
    report_progress(waiting);
  findings result;
  for (auto& run_check : looks)
    for (auto& x : run_check.end(begin + limit))
      result.push_back(std::move(x));
  return result;
}

const std::vector<check>& host_checks() {
  static const std::vector<check> all{
      {"interface", "network", "the interface is up and has an address",
       check_interface},
      {"mtu", "network", "datagrams of images need few fragments", check_mtu},
      {"multicast", "network", "nodes without --join see each other",
       check_multicast},
      {"ports", "network", "the ports of a node are free", check_node_ports},
      {"dds-ports", "network", "DDS has free ports, no program's by chance",
       check_dds_ports},
      {"firewall", "network", "whether nftables filters what arrives",
       check_firewall},
      {"buffers", "network", "sockets hold a whole image", check_buffers},
      {"shm", "host", "/dev/shm has room and may be used", check_shared_memory},
      {"leftovers", "host", "memory of Fast DDS that nobody uses, or not all",
       check_leftovers},
      {"disk", "host", "the data directory may be written and has room",
       check_disk},
      {"fsync", "host", "how long the disk takes to keep 4 KiB", check_fsync},
      {"clock", "host", "the clock is synchronised", check_clock},
      {"descriptors", "host", "how many files a node may open",
       check_descriptors},
      {"inotify", "host", "skills can follow files", check_inotify},
      {"engine", "host", "a container engine answers this user", check_engines},
      {"gpu", "host", "NVIDIA's driver and library fit", check_gpu},
      {"versions", "host", "ROSCell and Fast DDS", check_versions},
      {"skills", "host", "skills of this host can be loaded", check_skills},
      {"site-token", "host", "what proves a node to the others of its site",
       check_site_token},
      {"node-user", "host", "the node is not root", check_node_user},
      {"skill-owners", "host", "nobody else decides what a node of root runs",
       check_skill_owners},
  };
  return all;
}

findings check_own_host(const node_config& config) {
  checked_host host;
  host.config = config;
  host.interface = config.address;
  host.node_runs = true;
  follow_node_of(host);
  // Who asks waits no longer than for a check of its own.
  constexpr auto limit = longest_check - std::chrono::seconds{2};
  return run_checks(
      host_checks(), host, [](const auto&) {}, limit);
}

} // namespace roscell::cli
