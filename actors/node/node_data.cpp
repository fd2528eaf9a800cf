#include "actors/node/node_data.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/disk/data_folder.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/site/node_identity.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

namespace fs = std::filesystem;

/// What a table holds, by key.
using documents = std::map<std::string, json>;

fs::path database_of(const node_config& config) {
  return config.data_dir / "state.db";
}

fs::path token_of(const node_config& config) {
  return config.data_dir / "token";
}

/// Every record is JSON that this program has written: what is none tells that
/// the file has been damaged.
caf::expected<documents> read_table(const node_config& config, node_data& data,
                                    const std::string& table) {
  auto loaded = data.database->load(table);
  if (auto* why = std::get_if<edge_error>(&loaded))
    return to_caf(*why);
  documents result;
  for (const auto& [key, value] :
       std::get<std::vector<sqlite_store::record>>(loaded)) {
    result[key] = json::parse(value, nullptr, false);
    if (result[key].is_discarded())
      return to_caf(damaged_store(database_of(config), "the record '" + key
                                                           + "' of '" + table
                                                           + "' is no JSON"));
  }
  return result;
}

/// What another version has written and this one does not understand is not
/// worth a node that does not start, but it is told.
template <class T>
std::optional<T> understand(node_data& data, const std::string& table,
                            const std::string& key, const json& document) {
  auto decoded = decode<T>(document);
  if (auto* x = std::get_if<T>(&decoded))
    return std::move(*x);
  data.unread.push_back({table, key, std::get<failure>(decoded).message});
  return std::nullopt;
}

template <class T>
caf::error load_records(const node_config& config, node_data& data,
                        const std::string& table, std::vector<T>& result) {
  const auto found = read_table(config, data, table);
  if (!found)
    return found.error();
  for (const auto& [key, document] : *found)
    if (auto x = understand<T>(data, table, key, document))
      result.push_back(std::move(*x));
  return caf::none;
}

/// A node that was here has left its token, which it makes after its identity.
bool was_here(const node_config& config) {
  std::error_code ignored;
  return fs::exists(token_of(config), ignored);
}

caf::error put_database_aside(const node_config& config, node_data& data) {
  auto done = put_aside(database_of(config));
  if (auto* why = std::get_if<edge_error>(&done))
    return to_caf(*why);
  data.put_aside = std::get<fs::path>(std::move(done));
  return caf::none;
}

/// SQLite would take an empty file for a new one.
caf::error refuse_emptied(const node_config& config) {
  std::error_code problem;
  if (fs::file_size(database_of(config), problem) != 0 || problem
      || !was_here(config))
    return caf::none;
  return to_caf(damaged_store(database_of(config), "it is empty"));
}

caf::error open_database(const node_config& config, node_data& data) {
  if (auto why = config.new_identity ? put_database_aside(config, data)
                                     : refuse_emptied(config))
    return why;
  auto database = sqlite_store::open(database_of(config));
  if (auto* why = std::get_if<edge_error>(&database))
    return to_caf(*why);
  data.database = std::make_shared<sqlite_store>(
      std::get<sqlite_store>(std::move(database)));
  // What the node is comes before what it has said.
  data.database->set_room_maker(
      [past = data.past] { return past->make_room(); });
  return caf::none;
}

caf::error make_identity(node_data& data) {
  const auto& site = data.site.identity();
  data.identity.uuid = site ? site->who().uuid : make_uuid();
  data.is_new = data.put_aside.empty();
  if (auto why =
          data.database->put("identity", "node", json(data.identity).dump()))
    return to_caf(*why);
  return caf::none;
}

/// A node that was there before keeps its UUID, and its identity has to say it.
caf::error check_identity(const node_config& config, const node_data& data) {
  const auto& site = data.site.identity();
  if (!site || site->who().uuid == data.identity.uuid)
    return caf::none;
  return fail(error_code::schema_violation,
              "the node in '" + config.data_dir.string() + "' has the UUID "
                  + data.identity.uuid + ", and its identity is of "
                  + text_of(site->who()) + " with UUID " + site->who().uuid,
              "",
              std::string{"make one for it: roscell site issue "}
                  + to_word(site->who().role) + " " + site->who().name
                  + " --uuid " + data.identity.uuid);
}

caf::error load_site(const node_config& config, node_data& data) {
  auto site = load_site_secret(config);
  if (!site)
    return site.error();
  data.site = std::move(*site);
  return caf::none;
}

/// Empty: the node is new, or its record makes no sense.
std::string uuid_in(const documents& table) {
  const auto i = table.find("node");
  return i == table.end() || !i->second.is_object()
             ? std::string{}
             : i->second.value("uuid", "");
}

/// By an invitation, or, where the site is kept on this machine, a coordinator
/// by itself at its first start. Else the node has a token.
/// @param uuid that of the node; empty: it is new.
caf::error become_somebody(const node_config& config, node_data& data,
                           const std::string& uuid) {
  if (!config.invitation.empty()) {
    if (auto why = take_invitation(config, uuid.empty() ? make_uuid() : uuid))
      return why;
  } else if (uuid.empty() && keeps_site(config)) {
    if (auto why = issue_own_identity(config, make_uuid()))
      return why;
  } else {
    return caf::none;
  }
  return load_site(config, data);
}

/// `existed`: the database was there before this start.
caf::error load_identity(const node_config& config, node_data& data,
                         const documents& table, bool existed) {
  const auto i = table.find("node");
  if (!data.site.identity())
    if (auto why = become_somebody(config, data, uuid_in(table)))
      return why;
  if (i == table.end() && existed && was_here(config))
    return to_caf(
        damaged_store(database_of(config), "it does not say who the node is"));
  if (i == table.end())
    return make_identity(data);
  auto known = understand<node_identity>(data, "identity", "node", i->second);
  if (!known || known->uuid.empty())
    return to_caf(
        damaged_store(database_of(config), "it does not say who the node is"));
  data.identity = std::move(*known);
  return check_identity(config, data);
}

/// A cell has a UUID of its own from its first start on; its members follow it.
caf::error load_cell_uuid(node_data& data, const documents& table) {
  const auto known = table.find("cell_uuid");
  if (known != table.end() && known->second.is_string())
    data.cell_uuid = known->second.get<std::string>();
  if (!data.cell_uuid.empty())
    return caf::none;
  data.cell_uuid = make_uuid();
  if (auto why = data.database->put("identity", "cell_uuid",
                                    json(data.cell_uuid).dump()))
    return to_caf(*why);
  return caf::none;
}

/// Of a coordinator: each start has a number of its own, written before it is
/// used.
caf::error raise_incarnation(node_data& data, const documents& table) {
  const auto i = table.find("incarnation");
  data.incarnation = i != table.end() && i->second.is_number_integer()
                         ? i->second.get<int64_t>() + 1
                         : 1;
  if (auto why = data.database->put("identity", "incarnation",
                                    std::to_string(data.incarnation)))
    return to_caf(*why);
  return caf::none;
}

caf::error load_self(const node_config& config, node_data& data, bool existed) {
  const auto table = read_table(config, data, "identity");
  if (!table)
    return table.error();
  if (auto why = load_identity(config, data, *table, existed))
    return why;
  if (const auto i = table->find("membership"); i != table->end())
    data.membership = understand<membership_record>(data, "identity",
                                                    "membership", i->second);
  if (!config.coordinator)
    return caf::none;
  if (const auto i = table->find("address");
      i != table->end() && i->second.is_string())
    data.led_from = i->second.get<std::string>();
  if (auto why = load_cell_uuid(data, *table))
    return why;
  return raise_incarnation(data, *table);
}

/// A word beside a row, if there is one.
void keep_word(const json& document, const char* name,
               const std::string& instance,
               std::map<std::string, std::string>& words) {
  if (const auto i = document.find(name); i != document.end() && i->is_string())
    words[instance] = i->get<std::string>();
}

/// With each row goes the address at which its program was started, and in
/// which boot of the host that was.
caf::error load_instances(const node_config& config, node_data& data) {
  const auto found = read_table(config, data, "instances");
  if (!found)
    return found.error();
  for (const auto& [key, document] : *found)
    if (auto x = understand<instance_row>(data, "instances", key, document)) {
      keep_word(document, "address", x->spec.instance, data.started_at);
      keep_word(document, "boot", x->spec.instance, data.started_in);
      data.instances.push_back(std::move(*x));
    }
  return caf::none;
}

caf::error load_tables(const node_config& config, node_data& data) {
  if (auto why = load_instances(config, data))
    return why;
  if (auto why = load_records(config, data, "tasks", data.tasks))
    return why;
  if (auto why = load_records(config, data, "members", data.members))
    return why;
  if (auto why = load_records(config, data, "transfers", data.transfers))
    return why;
  if (auto why = load_records(config, data, "history", data.history))
    return why;
  if (auto why = load_records(config, data, "drains", data.drains))
    return why;
  if (auto why = load_records(config, data, "builds", data.builds))
    return why;
  if (auto why = load_records(config, data, "task_sets", data.sets))
    return why;
  return load_records(config, data, "removed_builds", data.remains);
}

caf::error load_tokens(const node_config& config, node_data& data) {
  data.token_file = token_of(config).string();
  auto token = load_bearer_token(token_of(config));
  if (!token)
    return token.error();
  data.token = std::move(*token);
  return data.site.identity() ? caf::error{} : load_site(config, data);
}

/// Folders of programs that an earlier run has started and that no record
/// knows, since the record was lost.
std::vector<std::string> find_strays(const fs::path& folder,
                                     const std::vector<instance_row>& known) {
  std::vector<std::string> result;
  std::error_code problem;
  for (fs::directory_iterator i{folder, problem}, end; !problem && i != end;
       i.increment(problem)) {
    const auto name = i->path().filename().string();
    if (std::none_of(known.begin(), known.end(),
                     [&](const auto& x) { return x.spec.instance == name; }))
      result.push_back(name);
  }
  return result;
}

} // namespace

caf::expected<node_data> open_node_data(const node_config& config) {
  node_data data;
  auto lock = directory_lock::take(config.data_dir);
  if (auto* why = std::get_if<edge_error>(&lock))
    return to_caf(*why);
  data.lock = std::make_shared<directory_lock>(
      std::get<directory_lock>(std::move(lock)));
  data.past = std::make_shared<history_folder>(
      config.data_dir / "history",
      history_bound{config.history_bytes, config.history_age});
  std::error_code ignored;
  const bool existed =
      !config.new_identity && fs::exists(database_of(config), ignored);
  if (auto why = open_database(config, data))
    return why;
  // Who a new node is, its identity says.
  if (has_identity_file(config))
    if (auto why = load_site(config, data))
      return why;
  if (auto why = load_self(config, data, existed))
    return why;
  if (auto why = load_tables(config, data))
    return why;
  if (auto why = load_tokens(config, data))
    return why;
  data.strays = find_strays(config.data_dir / "instances", data.instances);
  return data;
}

caf::error keep_address(const node_data& data, const std::string& address) {
  if (data.led_from == address)
    return caf::none;
  if (auto why =
          data.database->put("identity", "address", json(address).dump()))
    return to_caf(*why);
  return caf::none;
}

} // namespace roscell
