#include "tools/roscell/doctor/host/rights.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/edge/session/site_token.hpp"
#include "actors/edge/trust/identity_file.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/site/node_identity.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/split_words.hpp"

#include <ctime>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <variant>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

constexpr auto why_token = "only nodes with the same site token come into one "
                           "cell, on one host too";

/// Where a node looks for its token, and why there.
struct token_place {
  fs::path file;
  std::string origin;
};

token_place place_for(const node_config& config) {
  if (!config.site_token_file.empty())
    return {config.site_token_file, "given by --site-token"};
  const auto own = own_site_token();
  const auto* reported = std::getenv(site_token_variable);
  return {own, reported != nullptr && own == fs::path{reported}
                   ? std::string{"named by $"} + site_token_variable
                   : "the one of " + own_user() + " on this host"};
}

finding judge_missing(const token_place& place) {
  return {judgement::warning,
          "there is no site token in '" + place.file.string() + "', "
              + place.origin,
          std::string{why_token} + ": " + site_token_hint(place.file)};
}

finding judge_identity(const std::filesystem::path& file, int64_t now_unix_s) {
  const auto read = read_identity_file(file);
  if (const auto* why = std::get_if<edge_error>(&read))
    return {judgement::broken, why->message, why->hint};
  const auto& own = std::get<own_identity>(read);
  const auto days =
      (own.chain.front().ends_unix_s() - now_unix_s) / limits::trust::day_s;
  const auto is = "the identity in " + file.string() + " is of "
                  + text_of(own.who()) + ", and ";
  constexpr int64_t soon_days = 30;
  if (days > soon_days)
    return {judgement::ok,
            is + "is good for " + std::to_string(days) + " more days"};
  return {days < 0 ? judgement::broken : judgement::warning,
          is
              + (days < 0 ? "has ended"
                          : "ends in " + std::to_string(days) + " days"),
          "no node of the site believes one that has ended",
          "roscell site issue " + std::string{to_word(own.who().role)} + " "
              + own.who().name + " --uuid " + own.who().uuid};
}

} // namespace

findings check_site_token(const checked_host& host) {
  if (has_identity_file(host.config))
    return {judge_identity(identity_file_of(host.config),
                           static_cast<int64_t>(std::time(nullptr)))};
  const auto place = place_for(host.config);
  std::error_code problem;
  if (place.file.empty() || (!fs::exists(place.file, problem) && !problem))
    return {judge_missing(place)};
  const auto file = shell_word(place.file.string());
  const auto read = read_site_token(place.file);
  if (const auto* why = std::get_if<edge_error>(&read))
    return {{judgement::broken, why->message,
             std::string{why_token} + ": " + why->hint,
             "ls -ld " + file + " && id"}};
  if (!open_secret_warning(place.file).empty())
    return {{judgement::warning,
             "every user of this machine can read the site token in "
                 + place.file.string(),
             "whoever has it commands the nodes of the site",
             "chmod 600 " + file}};
  return {{judgement::ok, "the site token is in " + place.file.string() + ", "
                              + place.origin + "; sha256sum " + file
                              + " tells whether another host has the same"}};
}

findings check_skill_owners(const checked_host& host) {
  findings result;
  for (const auto& x : find_open_skills(host.config))
    result.push_back({judgement::warning, x.what,
                      "a node of root runs what they put there", x.remedy});
  if (result.empty())
    result.push_back(
        {judgement::ok, "no other user decides what a node runs as root"});
  return result;
}

namespace {

constexpr auto mover = "/usr/lib/roscell/move-to-user";

constexpr auto why_user =
    "a fault of a skill, or whoever commands the node, has all of this host";

} // namespace

bool is_kept_root(const std::filesystem::path& units) {
  std::error_code problem;
  return std::filesystem::exists(units / "roscell.service.d/as-root.conf",
                                 problem);
}

std::string root_warning(uid_t user, bool kept) {
  if (user != 0)
    return {};
  std::string result =
      "this node runs as root, and so do its skills that are processes";
  return kept ? result + "; when nothing runs that it has started, " + mover
                    + " gives it to the user roscell"
              : result + "; a user of its own will do";
}

finding judge_node_user(std::optional<uid_t> owner, bool kept) {
  if (!owner)
    return {judgement::skipped, "no node has run here yet"};
  if (*owner != 0)
    return {judgement::ok, "the node is not root"};
  return {judgement::warning,
          "the node runs as root, and its skills that are processes with it",
          why_user,
          kept ? mover
               : "adduser --system --group roscell; see docs/service.md"};
}

findings check_node_user(const checked_host& host) {
  // What is there belongs to the node's user, whoever looks.
  struct stat status {};
  const auto state = host.config.data_dir / "state.db";
  std::optional<uid_t> owner;
  if (::stat(state.c_str(), &status) == 0)
    owner = status.st_uid;
  return {judge_node_user(owner, is_kept_root())};
}

namespace {

/// A folder of many skills that are all somebody's is told once.
std::string fault_of(const fs::path& dir) {
  if (auto fault = who_may_replace(dir); !fault.empty())
    return fault;
  if (auto fault = who_may_change(dir); !fault.empty())
    return fault;
  std::error_code problem;
  for (fs::directory_iterator i{dir, problem}, end; !problem && i != end;
       i.increment(problem))
    if (const auto fault = who_may_change(i->path()); !fault.empty())
      return i->path().filename().string() + ": " + fault;
  return {};
}

} // namespace

std::vector<open_skills> find_open_skills(const node_config& config) {
  std::vector<open_skills> result;
  if (::geteuid() != 0)
    return result;
  auto dirs = config.skill_dirs;
  dirs.push_back(installed_skills(program_folder()));
  dirs.push_back(config.data_dir / "skills");
  std::error_code ignored;
  for (const auto& dir : dirs)
    if (fs::is_directory(dir, ignored))
      if (const auto fault = fault_of(dir); !fault.empty())
        result.push_back({"others decide what this node runs as root from "
                              + dir.string() + ": " + fault,
                          "chown -R root: " + shell_word(dir.string())
                              + " && chmod -R go-w "
                              + shell_word(dir.string())});
  return result;
}

} // namespace roscell::cli
