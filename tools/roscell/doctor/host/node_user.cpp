#include "tools/roscell/doctor/host/node_user.hpp"

#include <sys/stat.h>

#include <system_error>

namespace roscell::cli {

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

} // namespace roscell::cli
