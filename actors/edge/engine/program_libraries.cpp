#include "actors/edge/engine/program_libraries.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "actors/house/limits.hpp"

#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Programs and libraries of one folder that are looked into.
constexpr size_t max_programs = 256;
constexpr size_t max_entries = 10'000;
constexpr size_t max_listing_bytes = 256 * 1024;

/// The dynamic linker that runs this very program.
fs::path own_linker() {
  std::string result;
  ::dl_iterate_phdr(
      [](dl_phdr_info* info, size_t, void* out) {
        for (int i = 0; i < info->dlpi_phnum; ++i)
          if (info->dlpi_phdr[i].p_type == PT_INTERP)
            *static_cast<std::string*>(out) = reinterpret_cast<const char*>(
                info->dlpi_addr + info->dlpi_phdr[i].p_vaddr);
        return 1; // The first object is the program itself.
      },
      &result);
  return result;
}

bool is_elf(const fs::path& path) {
  const unique_fd file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  std::array<char, 4> magic{};
  return file && ::read(file.get(), magic.data(), magic.size()) == 4
         && std::string_view{magic.data(), magic.size()} == "\177ELF";
}

/// Everything in the folder that may load libraries, `program` first.
std::vector<fs::path> programs_in(const fs::path& folder,
                                  const fs::path& program) {
  std::vector<fs::path> result;
  if (is_elf(program))
    result.push_back(program);
  size_t entries = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator i{folder, error}, end;
       !error && i != end && ++entries < max_entries
       && result.size() < max_programs;
       i.increment(error))
    if (i->is_regular_file(error) && i->path() != program && is_elf(i->path()))
      result.push_back(i->path());
  return result;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const auto inside = path.lexically_relative(folder);
  return !inside.empty() && *inside.begin() != "..";
}

edge_error missing(const fs::path& program, const std::string& library) {
  return {error_code::engine_failed,
          "'" + program.string() + "' needs the library " + library
              + ", which this node does not have",
          "install the package that has it: apt-file search " + library};
}

edge_result<shared_library> look_at(const needed_library& needed) {
  std::error_code error;
  shared_library result;
  result.name = needed.name;
  result.file = fs::canonical(needed.path, error);
  struct stat info {};
  if (error || ::stat(result.file.c_str(), &info) != 0)
    return edge_error{error_code::internal,
                      "cannot read the library '" + needed.path + "'", ""};
  result.bytes = static_cast<uint64_t>(info.st_size);
  result.modified_unix_s = info.st_mtim.tv_sec;
  return result;
}

} // namespace

std::vector<needed_library> parse_library_list(std::string_view words) {
  constexpr std::string_view arrow = " => ";
  std::vector<needed_library> result;
  while (!words.empty()) {
    const auto end = words.find('\n');
    auto line = words.substr(0, end);
    words.remove_prefix(end == std::string_view::npos ? words.size() : end + 1);
    const auto at = line.find(arrow);
    if (at == std::string_view::npos || line.front() != '\t')
      continue;
    auto path = line.substr(at + arrow.size());
    path = path.substr(0, path.rfind(" (0x"));
    if (path.empty() || path.front() != '/')
      path = {};
    result.push_back({std::string{line.substr(1, at - 1)}, std::string{path}});
  }
  return result;
}

bool is_c_library(std::string_view name) {
  // The libraries of Debian's libc6, without their versions.
  constexpr std::string_view stems[] = {"libc",
                                        "libm",
                                        "libmvec",
                                        "libpthread",
                                        "libdl",
                                        "librt",
                                        "libutil",
                                        "libanl",
                                        "libresolv",
                                        "libthread_db",
                                        "libnsl",
                                        "libBrokenLocale",
                                        "libc_malloc_debug",
                                        "libpcprofile"};
  const auto stem = name.substr(0, name.find(".so"));
  return std::find(std::begin(stems), std::end(stems), stem) != std::end(stems)
         || name.substr(0, 8) == "ld-linux" || name.substr(0, 7) == "libnss_"
         || name.substr(0, 10) == "linux-vdso";
}

namespace {

/// Where this node itself finds libraries beside the system's: in its own image
/// they lie together.
std::map<std::string, std::string> linker_environment() {
  const auto* folders = std::getenv("LD_LIBRARY_PATH");
  if (folders == nullptr)
    return {};
  return {{"LD_LIBRARY_PATH", folders}};
}

} // namespace

edge_result<std::vector<shared_library>>
find_libraries(const fs::path& folder, const fs::path& program) {
  std::map<std::string, shared_library> found;
  const auto linker = own_linker();
  for (const auto& path : programs_in(folder, program)) {
    const auto words =
        run_program({linker, {"--list", path.string()}, linker_environment()},
                    limits::engine::linker, max_listing_bytes);
    if (const auto* error = std::get_if<edge_error>(&words)) {
      // Other files may be made for other machines.
      if (path != program)
        continue;
      return *error;
    }
    for (const auto& x : parse_library_list(std::get<std::string>(words))) {
      if (is_c_library(x.name) || found.count(x.name) > 0)
        continue;
      if (x.path.empty() && path == program)
        return missing(program, x.name);
      if (x.path.empty() || x.name.find('/') != std::string::npos)
        continue;
      auto library = look_at(x);
      if (auto* error = std::get_if<edge_error>(&library))
        return *error;
      if (auto& y = std::get<shared_library>(library); !lies_in(y.file, folder))
        found.emplace(x.name, std::move(y));
    }
  }
  std::vector<shared_library> result;
  result.reserve(found.size());
  for (auto& [name, x] : found)
    result.push_back(std::move(x));
  return result;
}

} // namespace roscell
