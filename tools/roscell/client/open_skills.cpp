#include "tools/roscell/client/open_skills.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/host/own_process.hpp"
#include "tools/roscell/split_words.hpp"

#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

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
