#include "tools/roscell/skills/build_upload.hpp"

#include "actors/builds/limits.hpp"
#include "actors/edge/disk/build_pieces.hpp"
#include "actors/edge/http/http_target.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <string>
#include <variant>

namespace roscell::cli {

namespace {

/// Which pieces a node says that it has.
std::string pieces_in(const json& reply, size_t count) {
  auto pieces = reply.value("pieces", std::string{});
  if (pieces.size() != count)
    throw command_error{
        exit_unreachable,
        "the node does not say which pieces of the build it has",
        "is it of this version of ROSCell?"};
  return pieces;
}

std::string bytes_of_piece(const std::filesystem::path& folder,
                           const described_build& build, size_t piece) {
  auto bytes = read_piece(folder, build.manifest, piece);
  if (const auto* why = std::get_if<edge_error>(&bytes))
    throw command_error{exit_refused, printable(why->message),
                        "do not edit the folder while it is added"};
  return std::get<std::string>(std::move(bytes));
}

} // namespace

void upload_build(const node_client& node, const std::filesystem::path& folder,
                  const described_build& build,
                  const upload_progress& on_progress) {
  const auto path = std::string{builds_path} + build.name.hash;
  const auto begun = unless_refused(
      node.post(path + "/manifest?manifest=" + build.name.manifest
                    + "&bytes=" + std::to_string(build.name.bytes),
                build.text, limits::build::disk),
      false);
  const auto pieces = pieces_in(begun, build.manifest.pieces.size());
  uint64_t done = 0;
  const auto all = static_cast<uint64_t>(build.name.bytes);
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i] != '1')
      unless_refused(node.post(path + "/pieces/" + std::to_string(i),
                               bytes_of_piece(folder, build, i),
                               limits::build::disk),
                     false);
    done += piece_size(build.manifest, i);
    on_progress(done, all);
  }
}

} // namespace roscell::cli
