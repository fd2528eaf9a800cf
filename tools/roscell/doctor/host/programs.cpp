#include "tools/roscell/doctor/host/programs.hpp"

#include "actors/core/program_version.hpp"
#include "actors/edge/host/installed_files.hpp"
#include "actors/instances/skill_catalogue.hpp"
#include "actors/node/node_runtime.hpp"
#include "tools/roscell/doctor/command_text.hpp"

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastrtps/config.h>

#include <dlfcn.h>
#include <sys/resource.h>

#include <filesystem>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// Sockets of members, peers, clients and instances of a large cell.
constexpr uint64_t few_descriptors = 4096;
constexpr uint64_t no_descriptors = 256;

/// The library whose code makes participants, by its real name.
std::string loaded_fast_dds() {
  Dl_info where{};
  const auto* code = reinterpret_cast<const void*>(
      &eprosima::fastdds::dds::DomainParticipantFactory::get_instance);
  if (dladdr(code, &where) == 0 || where.dli_fname == nullptr)
    return {};
  // The address may be that of this program's own way to the library.
  std::error_code error;
  return fs::canonical(where.dli_fname, error).string();
}

} // namespace

finding judge_descriptors(uint64_t most) {
  const auto seen = "a process may open " + std::to_string(most) + " files";
  if (most >= few_descriptors)
    return {judgement::ok, seen};
  return {most < no_descriptors ? judgement::broken : judgement::warning, seen,
          "a node needs some for each member, client and instance, and refuses "
          "what it has none for",
          "sudo prlimit --pid $$ --nofile=65536:65536   # of this shell; of a "
          "service LimitNOFILE=65536"};
}

finding judge_versions(const std::string& built, const std::string& loaded) {
  const auto seen = std::string{"roscell "} + program_version + ", Fast DDS "
                    + built + (loaded.empty() ? "" : " (" + loaded + ")");
  const auto file = fs::path{loaded}.filename().string();
  const auto number = file.find(".so.");
  if (number == file.npos || file.substr(number + 4) == built)
    return {judgement::ok, seen};
  return {
      judgement::warning, seen,
      "roscell was built with another version of Fast DDS than it runs with",
      "dpkg -S " + shell_word(loaded)};
}

findings judge_skills(size_t good, const std::vector<skill_problem>& problems) {
  findings result;
  for (const auto& x : problems) {
    auto folder = fs::path{x.path};
    if (folder.has_extension())
      folder = folder.parent_path();
    result.push_back({judgement::broken, x.path + ": " + x.message,
                      "a node leaves the skill out, and steps that need it are "
                      "not placed here",
                      "roscell skill check " + shell_word(folder.string())});
  }
  if (problems.empty())
    result.push_back({good == 0 ? judgement::skipped : judgement::ok,
                      good == 0 ? "this host has no skills"
                                : std::to_string(good) + " can be loaded"});
  return result;
}

findings check_descriptors(const checked_host& /*host*/) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
    return {{judgement::skipped, "the kernel does not report it"}};
  return {judge_descriptors(limit.rlim_max)};
}

findings check_versions(const checked_host& /*host*/) {
  return {judge_versions(FASTRTPS_VERSION_STR, loaded_fast_dds())};
}

findings check_skills(const checked_host& host) {
  auto dirs = host.config.skill_dirs;
  dirs.push_back(installed_skills(program_folder()));
  dirs.push_back(host.config.data_dir / "skills");
  std::vector<fs::path> there;
  std::error_code error;
  for (const auto& x : dirs)
    if (fs::is_directory(x, error))
      there.push_back(x);
  const auto runtime = choose_runtime(host.config);
  const auto found = skill_catalogue::scan(
      there, {own_architecture(), runtime && runtime->socket.empty()});
  return judge_skills(found.skills().size(), found.problems());
}

} // namespace roscell::cli
