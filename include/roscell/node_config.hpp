#pragma once

#include "roscell/web_page.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// How one node is set up. Every default is the one of `roscell node`.
struct node_config {
  std::string name; ///< Empty: "node-" and the MAC of the interface.
  bool coordinator = false;
  std::string cell;          ///< Empty: the node's own name. Coordinators only.
  std::string address;       ///< Local IPv4 address that everything binds to.
  uint16_t http_port = 8420; ///< HTTP, sessions, UDP heartbeat; 0: any free.
  uint16_t discovery_port = 11811; ///< Discovery server; 0: any free.
  /// Of the discovery server, in its prefix; none: the lowest that no visible
  /// coordinator has.
  std::optional<uint8_t> server_id;
  uint8_t ros_domain_id = 0;
  std::string join;  ///< "HOST[:PORT]" of a discovery server; empty: none.
  bool wait = false; ///< Do not ask for a slot: wait to be chosen.
  uint8_t public_domain_id = 99;  ///< Where nodes of the site see each other.
  std::vector<std::string> peers; ///< "HOST[:PORT]", besides multicast.
  bool rebalance = true; ///< The cell may be balanced. Coordinators only.
  bool force = false;    ///< Take a cell name that is in use.
  /// Clients of ROS 2 may change parameters of skills of the cell while these
  /// run; by DDS nobody proves who he is. Coordinators only.
  bool ros2_set_parameters = false;
  /// Of a coordinator with an identity: it places nothing but builds that an
  /// operator of its site has signed.
  bool require_signed_skills = false;
  /// auto, process, docker[:SOCKET] or podman[:SOCKET].
  std::string runtime = "auto";
  std::filesystem::path data_dir;
  /// Begin anew where a node has been before: what it knew is put aside.
  bool new_identity = false;
  std::filesystem::path socket; ///< Unix socket; empty: data_dir/node.sock.
  std::vector<std::filesystem::path> skill_dirs; ///< Besides the usual ones.
  /// Proves the nodes of a site to each other. Empty: the one of this user on
  /// this host, which his first coordinator makes.
  std::filesystem::path site_token_file;
  /// What the node is at a site of identities, in place of a token: see
  /// `roscell site issue`. A new node has the name and UUID that it says.
  /// Empty: DATA_DIR/identity.pem, where there is one.
  std::filesystem::path identity_file;
  /// By what a node without an identity gets one: the line that `roscell site
  /// invite` prints, or the name of a file with it.
  std::string invitation;
  std::filesystem::path shim; ///< roscell-instance-shim; empty: as installed.
  /// Where process instances get cgroups: a folder of the cgroup file system,
  /// "auto" or "none".
  std::string cgroup = "auto";
  std::string capacity; ///< "cpu=2,memory_mib=2048"; empty: all.
  /// Part of its cores on which the node counts however busy other programs
  /// keep them; 0: none.
  double cpu_floor = 0.25;
  std::map<std::string, std::string> labels;
  std::vector<std::string> devices; ///< Offered besides those found.
  /// "SKILL=WHAT[,WHAT...]": what a skill may have beyond an ordinary program's
  /// due. SKILL is a name or "*"; WHAT is capability:NAME, user:NAME or
  /// scheduling:POLICY:BOUND.
  std::vector<std::string> grants;
  uint64_t log_bytes = 1024 * 1024; ///< Bound of one instance's log.
  /// Bounds of what is kept of the past: events, and logs of instances that are
  /// gone. The oldest goes first.
  uint64_t history_bytes = 64 * 1024 * 1024;
  std::chrono::seconds history_age = std::chrono::hours{7 * 24};
  /// Of all builds of skills that come from other nodes. What was not used for
  /// longest goes when another one needs the room.
  uint64_t builds_bytes = 20ULL << 30;
  /// How to log in to registries of container images, in the form of Docker's
  /// config.json; empty: as the user of the engine does.
  std::filesystem::path registry_auth;
  /// Images of skills that are kept though no container has them. The oldest
  /// go first.
  uint64_t skill_images = 20;
  /// What is shown to whoever asks over the Unix socket. Coordinators only.
  web_pages pages;
};

} // namespace roscell
