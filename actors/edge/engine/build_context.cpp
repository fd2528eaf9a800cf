#include "actors/edge/engine/build_context.hpp"

#include "actors/edge/engine/limits.hpp"
#include "actors/edge/process/process_spawner.hpp"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr size_t max_words_bytes = 4096;
constexpr const char* prefix = "context-";

/// GNU tar, which every Debian has. Files belong to root and can be read by
/// everyone, for the instance may run as another user than the node.
program tar(std::vector<std::string> arguments) {
  program result{"/bin/tar",
                 {"--format=pax", "--sort=name", "--mtime=@0", "--owner=0",
                  "--group=0", "--numeric-owner", "--mode=a+rX,u+w",
                  "--pax-option=delete=atime,delete=ctime"},
                 {{"LC_ALL", "C"}}};
  result.arguments.insert(result.arguments.end(), arguments.begin(),
                          arguments.end());
  return result;
}

edge_error failed(const fs::path& place, const std::string& why) {
  return {error_code::engine_failed,
          "cannot write the build context '" + place.string() + "': " + why,
          "check that the data directory is writable and has room for a copy "
          "of the skill"};
}

/// A folder in which the first part of the context looks as it will.
class stage {
public:
  explicit stage(const fs::path& work_dir) {
    std::error_code error;
    fs::create_directories(work_dir, error);
    std::string name = work_dir / (std::string{prefix} + "XXXXXX");
    if (::mkdtemp(name.data()) != nullptr)
      path_ = name;
    else
      problem_ = std::strerror(errno);
  }

  ~stage() {
    std::error_code ignored;
    if (!path_.empty())
      fs::remove_all(path_, ignored);
  }

  stage(const stage&) = delete;
  stage& operator=(const stage&) = delete;

  /// Why it could not be filled; empty if it was.
  std::string fill(const image_content& content) {
    if (path_.empty())
      return problem_;
    const auto libraries = path_ / "opt/roscell/lib";
    std::error_code error;
    fs::create_directories(libraries, error);
    for (const auto& x : content.libraries)
      if (!error)
        fs::create_symlink(x.file, libraries / x.name, error);
    std::ofstream file{path_ / "Dockerfile", std::ios::binary};
    file << content.dockerfile << std::flush;
    return error ? error.message() : file ? "" : std::strerror(errno);
  }

  const fs::path& path() const {
    return path_;
  }

private:
  fs::path path_;
  std::string problem_;
};

} // namespace

edge_result<fs::path> write_build_context(const image_content& content,
                                          const fs::path& work_dir) {
  stage first_part{work_dir};
  if (const auto why = first_part.fill(content); !why.empty())
    return failed(work_dir, why);
  auto file = first_part.path();
  file += ".tar";
  // Libraries are linked under the names that programs ask for, and their
  // content is taken. Links inside the skill stay links.
  const program steps[] = {
      tar({"--create", "--dereference", "--file", file.string(), "--directory",
           first_part.path().string(), "Dockerfile", "opt"}),
      tar({"--append", "--file", file.string(), "--hard-dereference",
           "--transform=s,^\\.,opt/roscell/skill,S", "--directory",
           content.skill_dir.string(), "."})};
  for (const auto& step : steps) {
    const auto done =
        run_program(step, limits::engine::pack_step, max_words_bytes);
    if (const auto* error = std::get_if<edge_error>(&done)) {
      std::error_code ignored;
      fs::remove(file, ignored);
      return failed(file, error->message);
    }
  }
  return file;
}

void clean_build_contexts(const fs::path& work_dir) {
  std::error_code error;
  for (fs::directory_iterator i{work_dir, error}, end; !error && i != end;
       i.increment(error)) {
    std::error_code ignored;
    if (i->path().filename().string().rfind(prefix, 0) == 0)
      fs::remove_all(i->path(), ignored);
  }
}

} // namespace roscell
