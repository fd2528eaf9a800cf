#include "actors/edge/engine/program_libraries.hpp"

#include "actors/edge/engine/limits.hpp"
#include "actors/edge/process/elf_properties.hpp"
#include "actors/edge/process/process_spawner.hpp"

#include <link.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
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

/// Whether the dynamic linker can be asked what a file loads.
bool may_load(const fs::path& path) {
  const auto properties = read_elf(path);
  return properties && !properties->is_static;
}

/// Everything in the folder that may load libraries, `program` first.
std::vector<fs::path> programs_in(const fs::path& folder,
                                  const fs::path& program) {
  std::vector<fs::path> result;
  if (may_load(program))
    result.push_back(program);
  size_t entries = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator i{folder, error}, end;
       !error && i != end && ++entries < max_entries
       && result.size() < max_programs;
       i.increment(error))
    if (i->is_regular_file(error) && i->path() != program
        && may_load(i->path()))
      result.push_back(i->path());
  return result;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const auto inside = path.lexically_relative(folder);
  return !inside.empty() && *inside.begin() != "..";
}

bool read_properties(shared_library& library) {
  struct stat info {};
  if (::stat(library.file.c_str(), &info) != 0)
    return false;
  library.bytes = static_cast<uint64_t>(info.st_size);
  library.modified_unix_s = info.st_mtim.tv_sec;
  return true;
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
  if (error || !read_properties(result))
    return edge_error{error_code::internal,
                      "cannot read the library '" + needed.path + "'", ""};
  return result;
}

} // namespace

bool is_still(const shared_library& library) {
  auto now = library;
  return read_properties(now) && now.bytes == library.bytes
         && now.modified_unix_s == library.modified_unix_s;
}

namespace {

/// "\tNAME => PATH (0xADDRESS)", or "not found" for the path.
std::optional<needed_library> parse_library(std::string_view line) {
  constexpr std::string_view arrow = " => ";
  const auto at = line.find(arrow);
  if (at == std::string_view::npos || line.front() != '\t')
    return std::nullopt;
  auto path = line.substr(at + arrow.size());
  path = path.substr(0, path.rfind(" (0x"));
  if (path.empty() || path.front() != '/')
    path = {};
  return needed_library{std::string{line.substr(1, at - 1)}, std::string{path}};
}

/// "PROGRAM: PATH: version `VERSION' not found (required by FILE)".
std::optional<needed_library> parse_lacking_version(std::string_view line) {
  constexpr std::string_view begin = ": version `";
  const auto at = line.find(begin);
  const auto end = line.find("' not found", at);
  if (at == std::string_view::npos || end == std::string_view::npos)
    return std::nullopt;
  const auto path = line.substr(0, at);
  const auto name = path.substr(path.rfind('/') + 1);
  const auto first = at + begin.size();
  return needed_library{std::string{name} + " ("
                            + std::string{line.substr(first, end - first)}
                            + ")",
                        ""};
}

} // namespace

std::vector<needed_library> parse_library_list(std::string_view listing) {
  std::vector<needed_library> result;
  while (!listing.empty()) {
    const auto end = listing.find('\n');
    const auto line = listing.substr(0, end);
    listing.remove_prefix(end == std::string_view::npos ? listing.size()
                                                        : end + 1);
    auto found = parse_library(line);
    if (!found)
      found = parse_lacking_version(line);
    if (found)
      result.push_back(std::move(*found));
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

/// Makes the dynamic linker list what it would load instead of starting it, and
/// go on where it finds a library missing, which its option `--list` does not.
/// It looks where this node itself finds libraries beside the system's: in its
/// own image they lie together.
std::map<std::string, std::string> linker_environment() {
  std::map<std::string, std::string> result{{"LD_TRACE_LOADED_OBJECTS", "1"}};
  if (const auto* folders = std::getenv("LD_LIBRARY_PATH"))
    result.emplace("LD_LIBRARY_PATH", folders);
  return result;
}

/// What the dynamic linker says of a program or library.
edge_result<std::vector<needed_library>> list_libraries(const fs::path& path) {
  auto listing =
      run_program({own_linker(), {path.string()}, linker_environment()},
                  limits::engine::linker, max_listing_bytes);
  if (auto* error = std::get_if<edge_error>(&listing))
    return std::move(*error);
  return parse_library_list(std::get<std::string>(listing));
}

} // namespace

edge_result<std::vector<std::string>>
missing_libraries(const fs::path& program) {
  const auto own = read_elf(own_linker());
  const auto properties = read_elf(program);
  std::vector<std::string> result;
  // One for another machine that this host emulates has a linker of its own.
  if (!properties || properties->is_static || !own
      || properties->architecture != own->architecture)
    return result;
  auto list = list_libraries(program);
  if (auto* error = std::get_if<edge_error>(&list))
    return std::move(*error);
  for (auto& x : std::get<std::vector<needed_library>>(list))
    if (x.path.empty())
      result.push_back(std::move(x.name));
  return result;
}

edge_result<std::vector<shared_library>>
find_libraries(const fs::path& folder, const fs::path& program) {
  std::map<std::string, shared_library> found;
  for (const auto& path : programs_in(folder, program)) {
    const auto list = list_libraries(path);
    if (const auto* error = std::get_if<edge_error>(&list)) {
      // Other files may be made for other machines.
      if (path != program)
        continue;
      return *error;
    }
    for (const auto& x : std::get<std::vector<needed_library>>(list)) {
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
