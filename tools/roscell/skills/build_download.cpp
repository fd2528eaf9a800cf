#include "tools/roscell/skills/build_download.hpp"

#include "actors/builds/limits.hpp"
#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/build_pieces.hpp"
#include "actors/edge/http/http_target.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <optional>
#include <string>
#include <system_error>
#include <variant>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

void throw_if(const std::optional<edge_error>& why) {
  if (why)
    throw command_error{exit_refused, printable(why->message),
                        printable(why->hint)};
}

void write_build(const node_client& node, const build_name& build,
                 const build_manifest& manifest, const fs::path& folder) {
  const auto path = std::string{builds_path} + build.hash + "/pieces/";
  throw_if(begin_build(folder, manifest));
  for (size_t i = 0; i < manifest.pieces.size(); ++i)
    throw_if(write_piece(
        folder, manifest, i,
        node.get_bytes(path + std::to_string(i), {limits::build::piece_call})));
  throw_if(finish_build(folder, manifest, build));
}

} // namespace

void download_build(const node_client& node, const build_name& build,
                    const fs::path& folder) {
  const auto text =
      node.get_bytes(std::string{builds_path} + build.hash + "/manifest",
                     {limits::build::piece_call});
  const auto manifest = parse_manifest(text, build);
  if (const auto* why = std::get_if<edge_error>(&manifest))
    throw_if(*why);
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)))
    throw command_error{exit_refused,
                        "'" + printable(folder.string()) + "' is there already",
                        "name another one with --into"};
  try {
    write_build(node, build, std::get<build_manifest>(manifest), folder);
  } catch (...) {
    fs::remove_all(folder, error);
    throw;
  }
}

} // namespace roscell::cli
