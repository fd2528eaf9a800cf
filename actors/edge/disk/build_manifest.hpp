#pragma once

#include "actors/edge/disk/folder_files.hpp"
#include "messages/build.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

/// What a build consists of, as text and back. See messages/build.hpp.
namespace roscell {

/// A build that was read from a folder.
struct described_build {
  build_name name;
  build_manifest manifest;
  std::string text; ///< The manifest as it is stored and sent.
};

/// Reads all files of a folder. Blocks on the disk.
/// Errors: as `hash_folder`; internal where the folder changes meanwhile.
edge_result<described_build>
describe_folder(const std::filesystem::path& folder,
                const folder_limits& limits = {});

/// Reads a manifest that came from outside: its text must be what `name` says,
/// its paths stay inside a folder and come once and in order, and what it says
/// fits itself and the build's hash.
/// Errors: schema_violation.
edge_result<build_manifest> parse_manifest(std::string_view text,
                                           const build_name& name,
                                           const folder_limits& limits = {});

/// The hash of a folder that holds these files.
std::string hash_of(const build_manifest& manifest);

/// Of all files.
uint64_t bytes_of(const build_manifest& manifest);

/// Of a piece: all have one size but the last.
uint64_t piece_size(const build_manifest& manifest, size_t piece);

} // namespace roscell
