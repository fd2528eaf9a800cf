#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/build.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// A build that is written piece by piece into its files, where they will
/// stay: nothing is unpacked, and a piece is read from whole and unfinished
/// builds alike. Nothing in it can be executed and no link is there before all
/// of it is checked. All of these block on the disk; manifests are those that
/// `parse_manifest` has given.
namespace roscell {

/// A piece of the build in `folder`.
/// Errors: internal (a file cannot be read), conflict (it holds other bytes
/// than the manifest says).
edge_result<std::string> read_piece(const std::filesystem::path& folder,
                                    const build_manifest& manifest,
                                    size_t piece);

/// Makes the files of a build at their full size, which are there already or
/// not. Errors: internal (the disk is full or cannot be written); what was made
/// stays.
std::optional<edge_error> begin_build(const std::filesystem::path& folder,
                                      const build_manifest& manifest);

/// Which pieces of a build are in `folder`, by their bytes.
std::vector<bool> find_pieces(const std::filesystem::path& folder,
                              const build_manifest& manifest);

/// Errors: schema_violation (they are not the bytes of that piece; nothing is
/// written), internal (the disk).
std::optional<edge_error> write_piece(const std::filesystem::path& folder,
                                      const build_manifest& manifest,
                                      size_t piece, std::string_view bytes);

/// Makes a build of files whose pieces are all written: sets links and rights,
/// has the disk keep it, and reads all of it once more.
/// Errors: conflict (it is another build), internal (the disk).
std::optional<edge_error> finish_build(const std::filesystem::path& folder,
                                       const build_manifest& manifest,
                                       const build_name& name);

} // namespace roscell
