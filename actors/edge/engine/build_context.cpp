#include "actors/edge/engine/build_context.hpp"

#include "actors/edge/engine/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "messages/codec/json_codec.hpp"

#include <sys/stat.h>

#include <algorithm>
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

namespace {

std::string text_of(const timespec& when) {
  return std::to_string(when.tv_sec) + '.' + std::to_string(when.tv_nsec);
}

} // namespace

std::string mark_of(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0)
    return {};
  return std::to_string(info.st_dev) + ' ' + std::to_string(info.st_ino) + ' '
         + std::to_string(info.st_size) + ' ' + text_of(info.st_mtim) + ' '
         + text_of(info.st_ctim);
}

bool are_unchanged(const file_marks& marks) {
  return std::all_of(marks.begin(), marks.end(), [](const auto& x) {
    return !x.second.empty() && mark_of(x.first) == x.second;
  });
}

namespace {

/// Marks the hash as this use's own.
constexpr std::string_view hash_key = "roscell image";

constexpr size_t tag_digits = 32;

/// JSON in one line, whatever bytes are in it.
std::string in_one_line(const json& value) {
  return value.dump(-1, ' ', true, json::error_handler_t::replace);
}

json program_in_image(const image_recipe& recipe) {
  json result = recipe.entry_point;
  result[0] = std::string{image_skill_dir} + '/' + recipe.entry_point.at(0);
  return result;
}

/// A path component of an image name: lower-case letters and digits, with
/// single separators between them.
std::string repository_of(const std::string& operation) {
  std::string result;
  for (const char c : operation) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      result += upper ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  if (!result.empty() && result.back() == '_')
    result.pop_back();
  return result.empty() ? "skill" : result;
}

} // namespace

std::string dockerfile_of(const image_recipe& recipe) {
  std::string text = "FROM " + recipe.base_image + "\n";
  // One line each; a name with a line feed must not become an instruction.
  for (const auto& x : recipe.libraries)
    text += "# " + in_one_line(x.name) + " is " + in_one_line(x.file.string())
            + ", " + std::to_string(x.bytes) + " bytes of "
            + std::to_string(x.modified_unix_s) + "\n";
  text += "COPY opt /opt\n";
  if (!recipe.libraries.empty())
    text += std::string{"ENV LD_LIBRARY_PATH="} + image_library_dir + "\n";
  text += std::string{"WORKDIR "} + image_skill_dir + "\n";
  text += "LABEL roscell.skill=" + recipe.skill + "\n";
  if (!recipe.entry_point.empty())
    text += "ENTRYPOINT " + in_one_line(program_in_image(recipe)) + "\n";
  return text;
}

std::string image_name(const std::string& operation,
                       const std::string& dockerfile) {
  return "roscell/" + repository_of(operation) + ':'
         + to_hex(hmac_sha256(hash_key, dockerfile)).substr(0, tag_digits);
}

} // namespace roscell
