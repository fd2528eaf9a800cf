#pragma once

#include "actors/cell/sets/set_table.hpp"
#include "actors/cell/tables/cell_builds.hpp"
#include "actors/cell/tables/cell_registry.hpp"
#include "actors/cell/tables/history_table.hpp"
#include "actors/cell/tables/task_table.hpp"
#include "actors/cell/tables/transfer_table.hpp"
#include "actors/edge/disk/data_folder.hpp"
#include "actors/edge/disk/sqlite_store.hpp"
#include "actors/edge/history/history_folder.hpp"
#include "actors/edge/session/site_token.hpp"
#include "messages/inside/membership.hpp"
#include "messages/node.hpp"
#include "roscell/node_config.hpp"

#include <caf/expected.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// A record that this version does not understand.
struct unread_record {
  std::string table;
  std::string key;
  std::string why;
};

/// What a node keeps in its data directory, as found at the start.
struct node_data {
  std::shared_ptr<directory_lock> lock; ///< Held while the node lives.
  std::shared_ptr<sqlite_store> database;
  std::shared_ptr<history_folder> past; ///< Events, and logs of what is gone.
  node_identity identity;  ///< UUID and epoch; name and address are not set.
  bool is_new = false;     ///< It was made at this start.
  int64_t incarnation = 0; ///< Of the coordinator, already raised.
  std::string cell_uuid;   ///< Of the cell that it coordinates.
  std::string led_from;    ///< Its address when it last did; empty: never.
  std::optional<membership_record> membership; ///< Of a primary node.
  std::vector<member_record> members;          ///< Of a coordinator.
  std::vector<transfer_row> transfers;         ///< The same.
  std::vector<history_record> history;         ///< The same.
  std::vector<drain_record> drains;            ///< The same.
  std::vector<cell_build> builds;              ///< The same.
  std::vector<build_remains> remains;          ///< The same.
  std::vector<task_set_record> sets;           ///< The same.
  std::vector<instance_row> instances;
  /// Where the node was when their programs were started, by instance.
  std::map<std::string, std::string> started_at;
  /// In which boot of the host they were.
  std::map<std::string, std::string> started_in;
  std::vector<task_record> tasks;
  std::vector<unread_record> unread; ///< They stay where they are.
  std::vector<std::string> strays;   ///< Instances that no record knows.
  std::filesystem::path put_aside;   ///< The former database; empty: none was.
  std::string token_file;
  std::string token; ///< Bearer token for HTTP over TCP.
  site_secret site;  ///< Proves the node to others of its site.
};

/// Opens the data directory, making it and what belongs into it at the first
/// start: a UUID, and the bearer token in a file that only its owner can read.
/// A node never begins anew by itself where it has been before: a database that
/// cannot be trusted is an error, until `new_identity` puts it aside. Blocks on
/// the disk.
///
/// Errors: conflict (another node uses the directory), internal (no permission,
/// disk full, damaged database), unauthorized (a bad site token file).
caf::expected<node_data> open_node_data(const node_config& config);

/// Writes down where the node leads its cell from, unless that is known.
/// Errors: internal (disk).
caf::error keep_address(const node_data& data, const std::string& address);

// The secrets that a node has in files. Least and most lengths:
// `limits::token`.

/// The bearer token for HTTP over TCP, in a file that only its owner can read;
/// made where there is none. Errors: internal (no permission, disk full).
caf::expected<std::string> load_bearer_token(const std::filesystem::path& file);

/// What proves the node to others of its site: the file that the configuration
/// names, or that of this user, which a coordinator makes where there is none.
/// Another node may learn of it later. Errors: those of `read_site_token` and
/// `make_site_token`.
caf::expected<site_secret> load_site_secret(const node_config& config);

} // namespace roscell
