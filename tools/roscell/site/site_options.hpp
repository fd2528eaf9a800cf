#pragma once

#include "actors/edge/trust/site_folder.hpp"
#include "messages/cell.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace roscell::cli {

/// What the commands below `site` are given; each uses some of it.
struct site_options {
  std::filesystem::path folder;
  connection_options connection;
  std::string role = "node";
  std::string name;
  std::string uuid;
  std::string good_for;
  std::filesystem::path out;
  std::vector<std::string> without;
  bool all = false;
  std::string output = "table";
};

using site_options_ptr = std::shared_ptr<site_options>;

/// For one answer of a node, and what it writes to its disk meanwhile.
constexpr std::chrono::seconds site_answer_limit{15};

int64_t unix_now_s();

std::filesystem::path folder_of(const site_options& options);

/// Throws command_error in place of an error.
template <class T>
T unless_failed(edge_result<T> result);
[[noreturn]] void give_up_site(const edge_error& why);

site_folder open_site(const site_options& options);

/// A command below `site`, with the option that all of them have.
CLI::App* add_command(CLI::App& site, const site_options_ptr& options,
                      const char* name, const char* what);

void run_by(CLI::App& command, action& chosen, const site_options_ptr& options,
            int (*run)(const site_options&));

/// That a text names a role that identities are made for; else why not.
std::string names_a_role(const std::string& text);

/// invite.
void add_inviting(CLI::App& site, action& chosen);

/// adopt, renew and rotate.
void add_adopting(CLI::App& site, action& chosen);

/// revoke.
void add_revoking(CLI::App& site, action& chosen);

/// The cell of a coordinator, himself the last: the others' answers come by
/// him. Throws as `node_client` does.
cell_description cell_at(const node_client& node);

template <class T>
T unless_failed(edge_result<T> result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    give_up_site(*why);
  return std::get<T>(std::move(result));
}

} // namespace roscell::cli
