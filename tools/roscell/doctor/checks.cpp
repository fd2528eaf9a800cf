#include "tools/roscell/doctor/checks.hpp"

#include "tools/roscell/doctor/host/clock.hpp"
#include "tools/roscell/doctor/host/disk.hpp"
#include "tools/roscell/doctor/host/doors.hpp"
#include "tools/roscell/doctor/host/engines.hpp"
#include "tools/roscell/doctor/host/gpu.hpp"
#include "tools/roscell/doctor/host/inotify.hpp"
#include "tools/roscell/doctor/host/memory_sharing.hpp"
#include "tools/roscell/doctor/host/node_user.hpp"
#include "tools/roscell/doctor/host/programs.hpp"
#include "tools/roscell/doctor/host/shared_memory.hpp"
#include "tools/roscell/doctor/network/addresses.hpp"
#include "tools/roscell/doctor/network/buffers.hpp"
#include "tools/roscell/doctor/network/firewall.hpp"
#include "tools/roscell/doctor/network/ports.hpp"
#include "tools/roscell/doctor/node/follow_node.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <future>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>

namespace roscell::cli {

namespace {

using look_clock = std::chrono::steady_clock;

/// What takes longer than this is told about.
constexpr std::chrono::seconds look_patience{1};

using look_result = std::shared_future<findings>;

/// The checks that were left to themselves and may still be going on. A node is
/// asked to look again and again: what hangs must not take a thread each time.
class left_looks {
public:
  void add(const std::string& name, look_result look) {
    const std::lock_guard lock{mutex_};
    looks_[name] = std::move(look);
  }

  /// Not valid if none of that name goes on.
  look_result find(const std::string& name) {
    const std::lock_guard lock{mutex_};
    const auto i = looks_.find(name);
    if (i == looks_.end())
      return {};
    if (i->second.wait_for(std::chrono::seconds{0})
        != std::future_status::ready)
      return i->second;
    looks_.erase(i);
    return {};
  }

private:
  std::mutex mutex_;
  std::map<std::string, look_result> looks_;
};

/// For as long as the program runs, as the threads do.
left_looks& left_of_program() {
  static auto* all = new left_looks;
  return *all;
}

/// A check that is being made, by a thread of its own, which may stay in the
/// kernel for ever.
class running_look {
public:
  running_look(const check& what, const examined_host& host)
      : what_{what}, result_{left_of_program().find(what.name)} {
    if (result_.valid())
      return;
    std::packaged_task<findings()> task{
        [look = what.look, host] { return look(host); }};
    result_ = task.get_future();
    try {
      thread_ = std::thread{std::move(task)};
    } catch (const std::system_error& e) {
      not_begun_ = e.what();
    }
  }

  bool ends_until(look_clock::time_point deadline) const {
    return result_.wait_until(deadline) == std::future_status::ready;
  }

  const check& what() const {
    return what_;
  }

  /// To be called once.
  findings end(look_clock::time_point deadline) {
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
            "what it looks at does not answer: a disk, a driver or a "
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
  look_result result_;
  std::thread thread_;
  std::string not_begun_; ///< Why there is no thread.
};

/// What its options do not say, a node knows itself; one that does not answer
/// is looked at by its options.
void follow_own_node(examined_host& host) {
  const auto& config = host.config;
  connection_options own;
  own.to = std::filesystem::absolute(config.socket.empty()
                                         ? config.data_dir / "node.sock"
                                         : config.socket)
               .string();
  try {
    const node_client node{own};
    follow_node(host, node, node.get("/v1/node").get<node_description>());
  } catch (const std::exception&) {
    return;
  }
}

} // namespace

const std::vector<check>& host_checks() {
  static const std::vector<check> all{
      {"interface", "network", "the interface is up and has an address",
       examine_interface},
      {"mtu", "network", "datagrams of images need few fragments", examine_mtu},
      {"multicast", "network", "nodes without --join see each other",
       examine_multicast},
      {"ports", "network", "the ports of a node are free", examine_ports},
      {"dds-ports", "network", "DDS has free ports, no program's by chance",
       examine_dds_ports},
      {"firewall", "network", "nftables lets a node's packets in",
       examine_firewall},
      {"buffers", "network", "sockets hold a whole image", examine_buffers},
      {"shm", "host", "/dev/shm has room and may be used",
       examine_shared_memory},
      {"shm-sharing", "host",
       "programs of Fast DDS can open each other's memory",
       examine_memory_sharing},
      {"leftovers", "host", "files in /dev/shm that nobody uses",
       examine_leftovers},
      {"disk", "host", "the data directory may be written and has room",
       examine_disk},
      {"fsync", "host", "how long the disk takes to keep 4 KiB", examine_fsync},
      {"clock", "host", "the clock is synchronised", examine_clock},
      {"descriptors", "host", "how many files a node may open",
       examine_descriptors},
      {"inotify", "host", "skills can follow files", examine_inotify},
      {"engine", "host", "a container engine answers this user",
       examine_engines},
      {"gpu", "host", "NVIDIA's driver and library fit", examine_gpu},
      {"versions", "host", "ROSCell and Fast DDS", examine_versions},
      {"skills", "host", "skills of this host can be loaded", examine_skills},
      {"site-token", "host", "what proves a node to the others of its site",
       examine_site_token},
      {"node-user", "host", "the node is not root", examine_node_user},
      {"skill-owners", "host", "nobody else decides what a node of root runs",
       examine_skill_owners},
  };
  return all;
}

findings run_checks(const std::vector<check>& checks, const examined_host& host,
                    const still_looking& tell,
                    std::chrono::milliseconds limit) {
  const auto begin = look_clock::now();
  const auto early =
      begin + std::min<look_clock::duration>(look_patience, limit);
  std::vector<running_look> looks;
  looks.reserve(checks.size());
  for (const auto& x : checks)
    looks.emplace_back(x, host);
  std::vector<std::string> waiting;
  for (const auto& x : looks)
    if (!x.ends_until(early))
      waiting.emplace_back(x.what().name);
  if (!waiting.empty())
    tell(waiting);
  findings result;
  for (auto& look : looks)
    for (auto& x : look.end(begin + limit))
      result.push_back(std::move(x));
  return result;
}

findings examine_own_host(const node_config& config) {
  examined_host host;
  host.config = config;
  host.interface = config.address;
  host.node_runs = true;
  follow_own_node(host);
  // Who asks waits no longer than for a check of its own.
  constexpr auto limit = longest_look - std::chrono::seconds{2};
  return run_checks(
      host_checks(), host, [](const auto&) {}, limit);
}

} // namespace roscell::cli
