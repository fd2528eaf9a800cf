#include "actors/node/node_data.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/house/edge_failure.hpp"
#include "actors/house/limits.hpp"
#include "messages/failure.hpp"
#include "schemas/decode.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace roscell {

namespace {

using records = std::vector<sqlite_store::record>;

namespace fs = std::filesystem;

/// A random UUID, version 4 of RFC 4122.
std::string make_uuid() {
  auto bytes = random_bytes(16);
  bytes[6] = static_cast<char>((bytes[6] & 0x0f) | 0x40);
  bytes[8] = static_cast<char>((bytes[8] & 0x3f) | 0x80);
  auto hex = to_hex(bytes);
  for (const size_t dash : {8, 13, 18, 23})
    hex.insert(dash, "-");
  return hex;
}

std::string trim(const std::string& text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end =
      std::find_if_not(text.rbegin(), text.rend(), is_space).base();
  return begin < end ? std::string{begin, end} : std::string{};
}

/// Writes a new file that only its owner can read.
caf::error write_secret(const fs::path& path, const std::string& text) {
  const int fd =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const auto size = static_cast<ssize_t>(text.size());
  const bool written = fd >= 0 && ::write(fd, text.data(), text.size()) == size
                       && ::fsync(fd) == 0;
  const int problem = errno;
  if (fd >= 0)
    ::close(fd);
  if (written)
    return caf::none;
  return fail(error_code::internal, "cannot write '" + path.string()
                                        + "': " + std::strerror(problem));
}

caf::error load_token(node_data& data, const fs::path& dir) {
  const auto path = dir / "token";
  data.token_file = path.string();
  if (!fs::exists(path))
    if (auto why = write_secret(path, to_hex(random_bytes(32)) + "\n"))
      return why;
  data.token =
      trim(read_small_file(path, limits::token::most_bytes).value_or(""));
  if (data.token.empty())
    return fail(error_code::internal,
                "cannot read the token in '" + path.string() + "'", "",
                "remove the file, and the node makes a new one");
  return caf::none;
}

caf::error load_site_token(node_data& data, const fs::path& path) {
  if (path.empty())
    return caf::none;
  const auto text = read_small_file(path, limits::token::most_bytes);
  if (!text)
    return fail(error_code::unauthorized,
                "cannot read the site token in '" + path.string() + "'", "",
                "give --site-token a file of at most 4096 bytes that this user "
                "can read");
  data.site_token = trim(*text);
  if (data.site_token.size() < limits::token::least_site_bytes)
    return fail(error_code::unauthorized,
                "the site token in '" + path.string()
                    + "' is shorter than 16 characters",
                "", "make one: head -c 32 /dev/urandom | xxd -p -c 64");
  return caf::none;
}

/// Reads what can be read of a table: a record of another version is not worth
/// a node that does not start.
template <class T>
caf::error load_records(sqlite_store& database, const std::string& table,
                        std::vector<T>& result) {
  auto loaded = database.load(table);
  if (auto* why = std::get_if<edge_error>(&loaded))
    return to_caf(*why);
  for (const auto& [key, value] : std::get<records>(loaded)) {
    const auto document = json::parse(value, nullptr, false);
    if (document.is_discarded())
      continue;
    auto decoded = decode<T>(document);
    if (auto* x = std::get_if<T>(&decoded))
      result.push_back(std::move(*x));
  }
  return caf::none;
}

/// The document of that key, or null.
json find_record(const records& table, const std::string& key) {
  for (const auto& [name, value] : table)
    if (name == key)
      if (auto document = json::parse(value, nullptr, false);
          !document.is_discarded())
        return document;
  return nullptr;
}

caf::error load_identity(node_data& data, bool coordinator) {
  auto& database = *data.database;
  auto loaded = database.load("identity");
  if (auto* why = std::get_if<edge_error>(&loaded))
    return to_caf(*why);
  const auto& table = std::get<records>(loaded);
  if (const auto known = find_record(table, "node"); !known.is_null()) {
    auto decoded = decode<node_identity>(known);
    if (auto* identity = std::get_if<node_identity>(&decoded))
      data.identity = std::move(*identity);
  }
  if (const auto known = find_record(table, "membership"); !known.is_null()) {
    auto decoded = decode<membership_record>(known);
    if (auto* record = std::get_if<membership_record>(&decoded))
      data.membership = std::move(*record);
  }
  if (data.identity.uuid.empty()) {
    data.identity.uuid = make_uuid();
    if (auto why = database.put("identity", "node", json(data.identity).dump()))
      return to_caf(*why);
  }
  if (!coordinator)
    return caf::none;
  const auto known = find_record(table, "incarnation");
  data.incarnation = known.is_number_integer() ? known.get<int64_t>() + 1 : 1;
  if (auto why = database.put("identity", "incarnation",
                              std::to_string(data.incarnation)))
    return to_caf(*why);
  return caf::none;
}

} // namespace

caf::expected<node_data> open_node_data(const node_config& config) {
  node_data data;
  auto lock = directory_lock::take(config.data_dir);
  if (auto* why = std::get_if<edge_error>(&lock))
    return to_caf(*why);
  data.lock = std::make_shared<directory_lock>(
      std::get<directory_lock>(std::move(lock)));
  auto database = sqlite_store::open(config.data_dir / "state.db");
  if (auto* why = std::get_if<edge_error>(&database))
    return to_caf(*why);
  data.database = std::make_shared<sqlite_store>(
      std::get<sqlite_store>(std::move(database)));
  if (auto why = load_identity(data, config.coordinator))
    return why;
  if (auto why = load_token(data, config.data_dir))
    return why;
  if (auto why = load_site_token(data, config.site_token_file))
    return why;
  if (auto why = load_records(*data.database, "instances", data.instances))
    return why;
  if (auto why = load_records(*data.database, "tasks", data.tasks))
    return why;
  if (auto why = load_records(*data.database, "members", data.members))
    return why;
  if (auto why = load_records(*data.database, "transfers", data.transfers))
    return why;
  return data;
}

} // namespace roscell
