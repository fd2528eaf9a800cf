#include "actors/instances/skill_program.hpp"

#include "actors/edge/host/host_probe.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/instances/skill_descriptor_file.hpp"

#include <elf.h>
#include <fcntl.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace roscell {

namespace fs = std::filesystem;

namespace {

edge_error failed(const std::string& what, const fs::path& path,
                  const std::string& why, std::string hint) {
  return {error_code::engine_failed, what + " '" + path.string() + "': " + why,
          std::move(hint)};
}

} // namespace

edge_result<fs::path>
find_program(const fs::path& skill_dir,
             const std::vector<std::string>& entry_point) {
  const auto descriptor = descriptor_of(skill_dir).string();
  if (entry_point.empty())
    return failed("the skill in", skill_dir, "names no program",
                  "write \"entry_point\" into " + descriptor);
  const auto path = skill_dir / entry_point[0];
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return failed("the skill's program is missing:", path,
                  error ? error.message() : "it is no file",
                  "build the skill, or correct \"entry_point\" in "
                      + descriptor);
  if (::access(path.c_str(), X_OK) != 0)
    return failed("the skill's program cannot be run:", path,
                  std::strerror(errno), "chmod +x " + path.string());
  return path;
}

std::string architecture_of_program(const fs::path& program) {
  const unique_fd file{
      ::open(program.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  // The first fields are the same for 32 and 64 bits.
  Elf32_Ehdr header{};
  constexpr ssize_t needed = offsetof(Elf32_Ehdr, e_version);
  if (!file || ::read(file.get(), &header, needed) != needed
      || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    return {};
  switch (header.e_machine) {
  case EM_X86_64:
    return "amd64";
  case EM_AARCH64:
    return "arm64";
  case EM_ARM:
    return "arm";
  case EM_386:
    return "386";
  default:
    return {};
  }
}

bool runs_on(const std::string& architecture, const std::string& host) {
  return architecture.empty() || architecture == host
         || (architecture == "386" && host == "amd64")
         || (architecture == "arm" && host == "arm64");
}

std::string own_architecture() {
  utsname system{};
  return ::uname(&system) == 0 ? architecture_of(system.machine)
                               : std::string{};
}

} // namespace roscell
