#include "tools/roscell/doctor/checks.hpp"

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

namespace roscell::cli {

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
