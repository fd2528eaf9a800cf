#include "tools/roscell/skills/cell_skills.hpp"

#include "actors/builds/limits.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/trust/limits.hpp"
#include "messages/node.hpp"
#include "messages/skill.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/build_download.hpp"
#include "tools/roscell/skills/build_upload.hpp"
#include "tools/roscell/skills/unpack_archive.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <stdlib.h>

#include <cstdint>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

constexpr uint64_t bytes_of_mib = 1024 * 1024;

/// Where an archive is unpacked; gone with it.
class scratch_folder {
public:
  scratch_folder() {
    auto name = (std::filesystem::temp_directory_path() / "roscell-add-XXXXXX")
                    .string();
    if (::mkdtemp(name.data()) == nullptr)
      throw command_error{exit_refused,
                          "cannot make a folder in '" + name + "'",
                          "$TMPDIR says where"};
    path_ = name;
  }

  ~scratch_folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  scratch_folder(const scratch_folder&) = delete;
  scratch_folder& operator=(const scratch_folder&) = delete;

  const std::filesystem::path& path() const {
    return path_;
  }

private:
  std::filesystem::path path_;
};

/// The skill's folder: the one that was named, or what an archive holds.
std::filesystem::path skill_folder_of(const std::string& source,
                                      const scratch_folder& scratch) {
  std::error_code error;
  if (std::filesystem::is_directory(source, error))
    return source;
  if (!std::filesystem::is_regular_file(source, error))
    throw command_error{exit_usage,
                        "'" + printable(source)
                            + "' is neither a folder nor an archive",
                        "name the folder that holds skill.json, or a tar or "
                        "zip archive of it"};
  return unpack_archive(source, scratch.path());
}

described_build read_build(const std::filesystem::path& folder) {
  auto build = describe_folder(folder);
  if (const auto* why = std::get_if<edge_error>(&build))
    throw command_error{exit_refused, printable(why->message),
                        printable(why->hint)};
  return std::get<described_build>(std::move(build));
}

/// Says each tenth of what has come, to somebody who waits.
upload_progress shown_progress(const std::string& node) {
  constexpr uint64_t steps = 10;
  return [node, last = uint64_t{0}](uint64_t done, uint64_t all) mutable {
    const auto step = all == 0 ? steps : done * steps / all;
    if (step == last || !stderr_is_terminal())
      return;
    last = step;
    print_note(std::to_string(done / bytes_of_mib) + " of "
               + std::to_string(all / bytes_of_mib) + " MiB are on '"
               + printable(node) + "'");
  };
}

/// Empty: nobody has signed it.
std::string signature_beside(const std::string& source) {
  return read_small_file(signature_file_of(source),
                         limits::trust::identity_bytes)
      .value_or("");
}

std::string name_of(const node_client& node) {
  return node.get("/v1/node").get<node_description>().identity.name;
}

} // namespace

std::string build_hash_of(const std::string& source) {
  const scratch_folder scratch;
  return read_build(skill_folder_of(source, scratch)).name.hash;
}

std::filesystem::path signature_file_of(const std::string& source) {
  auto name = source;
  while (name.size() > 1 && name.back() == '/')
    name.pop_back();
  return name + ".signature";
}

json add_to_cell(const node_client& node, const std::string& source,
                 const std::string& hash, bool as_json) {
  const scratch_folder scratch;
  const auto folder = skill_folder_of(source, scratch);
  const auto build = read_build(folder);
  if (!hash.empty() && build.name.hash != hash)
    throw command_error{
        exit_refused,
        "'" + printable(source) + "' holds build "
            + build.name.hash.substr(0, limits::build::shown_digits) + ", not "
            + hash.substr(0, limits::build::shown_digits),
        "it was changed since; say the hash that it has now"};
  const auto name = name_of(node);
  upload_build(node, folder, build, shown_progress(name));
  return unless_refused(
      node.post("/v1/requests",
                message_json(
                    skill_addition{build.name, name, signature_beside(source)})
                    .dump(),
                limits::build::addition),
      as_json);
}

json pull_from_cell(const node_client& node, const std::string& operation,
                    const std::string& build,
                    const std::filesystem::path& folder, bool as_json) {
  skill_pull request;
  request.operation = operation;
  request.build = build;
  request.node = name_of(node);
  auto reply =
      unless_refused(node.post("/v1/requests", message_json(request).dump(),
                               limits::build::pull),
                     as_json);
  download_build(node, reply.get<skill_pulled>().pulled.build, folder);
  return reply;
}

} // namespace roscell::cli
