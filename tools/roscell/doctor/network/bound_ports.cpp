#include "tools/roscell/doctor/network/bound_ports.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/http/client/http_client.hpp"
#include "actors/edge/http/http_target.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/node.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <istream>
#include <set>
#include <sstream>
#include <variant>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// A row of /proc/net/udp and its like.
struct bound_row {
  unsigned port = 0;
  std::string inode;
  std::string state;
};

constexpr auto tcp_listens = "0A";

/// A node that lives tells its name far sooner.
constexpr std::chrono::seconds hello_limit{2};

using row_handler = std::function<void(const bound_row&)>;

void for_each_row(std::istream& table, const row_handler& look) {
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream words{line};
    std::string number, local, remote, queues, timer, retries, uid, timeout;
    bound_row row;
    words >> number >> local >> remote >> row.state >> queues >> timer
        >> retries >> uid >> timeout >> row.inode;
    const auto colon = local.rfind(':');
    if (colon == local.npos)
      continue;
    row.port = static_cast<unsigned>(
        std::strtoul(local.c_str() + colon + 1, nullptr, 16));
    look(row);
  }
}

void for_each_bound(const std::string& proc, const std::string& protocol,
                    const row_handler& look) {
  for (const auto* version : {"", "6"}) {
    std::ifstream table{proc + "/net/" + protocol + version};
    for_each_row(table, look);
  }
}

bool has_socket(const fs::path& process, const std::set<std::string>& links) {
  std::error_code error;
  for (fs::directory_iterator i{process / "fd", error}, end; !error && i != end;
       i.increment(error)) {
    std::error_code gone;
    if (links.count(fs::read_symlink(i->path(), gone).string()) != 0)
      return true;
  }
  return false;
}

std::string name_of_process(const fs::path& process) {
  constexpr size_t longest_name = 64;
  auto name = read_small_file(process / "comm", longest_name).value_or("?");
  return name.substr(0, name.find('\n'));
}

} // namespace

port_holder find_port_holder(const std::string& proc,
                             const std::string& protocol, unsigned port) {
  std::set<std::string> links;
  for_each_bound(proc, protocol, [&](const bound_row& row) {
    if (row.port == port && (protocol == "udp" || row.state == tcp_listens))
      links.insert("socket:[" + row.inode + "]");
  });
  std::error_code error;
  for (fs::directory_iterator i{proc, error}, end; !error && i != end;
       i.increment(error)) {
    const auto pid = std::atoll(i->path().filename().c_str());
    if (pid > 0 && !links.empty() && has_socket(i->path(), links))
      return {pid, name_of_process(i->path())};
  }
  return {};
}

std::string node_at(const std::string& address, uint16_t port) {
  // Without a token, which is no business of whoever listens there.
  const http_client there{{"", address, port, ""}};
  http_client::options how;
  how.timeout = hello_limit;
  const auto reply = there.request("GET", hello_path, "", how);
  const auto* said = std::get_if<http_reply>(&reply);
  if (said == nullptr)
    return {};
  try {
    return json::parse(said->body).get<node_hello>().node;
  } catch (const std::exception&) {
    return {};
  }
}

std::set<unsigned> ports_in(const std::string& table) {
  std::set<unsigned> result;
  std::istringstream rows{table};
  for_each_row(rows, [&](const bound_row& row) { result.insert(row.port); });
  return result;
}

std::set<unsigned> bound_udp_ports(const std::string& proc) {
  std::set<unsigned> result;
  for_each_bound(proc, "udp",
                 [&](const bound_row& row) { result.insert(row.port); });
  return result;
}

} // namespace roscell::cli
