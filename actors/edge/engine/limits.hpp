#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Container engines and the images that are built for skills.
namespace roscell::limits {

namespace engine {

/// For a call that takes an idle engine milliseconds.
constexpr seconds call{10};
/// For one that shows whether an engine is there.
constexpr seconds probe{2};
/// Creating a container copies nothing, but a loaded engine takes its time.
constexpr seconds create{20};
constexpr seconds start{20};
/// For an image's plan: hashing a folder, finding the libraries of programs.
constexpr seconds plan{60};
constexpr seconds linker{10};
/// For each of the packer's two steps: some GiB of checkpoints, a slow disk.
constexpr minutes pack_step{5};
constexpr minutes pack{11};
/// Shorter than the instance's limit, so that the log goes along.
constexpr minutes build{9};
/// For an image to come from another node, which is part of an instance's limit
/// for its image as a build is.
constexpr minutes bring{9};
/// For an image to be read from an engine, or written to it: some GiB on a slow
/// disk; and for tar to unpack or pack it.
constexpr minutes save{4};
constexpr minutes load{4};
constexpr minutes image_tar{2};
/// Room on the disk that an image leaves to others.
constexpr size_t spare_bytes = 64 * mib;
/// Images of which another node is told that their layers are there, and the
/// most layers; a message's schema says the same.
constexpr size_t inspected_images = 64;
constexpr size_t most_layers = 512;
/// What a saved image says of itself.
constexpr size_t image_config_bytes = 8 * mib;
/// A registry that says nothing for so long says nothing more.
constexpr seconds pull_silence{60};
/// For a program that knows logins, and what it may say; for the file too.
constexpr seconds login_helper{10};
constexpr size_t login_bytes = mib;
/// A build says no more than once in this time how it gets on.
constexpr seconds build_status{1};
/// Lines of a build that are kept for the case that it fails, and their bytes.
constexpr size_t kept_build_lines = 40;
constexpr size_t build_line_bytes = 512;
/// A line of a build or an event is some hundred bytes.
constexpr size_t line_bytes = mib;
/// Longest body of an answer that is no stream.
constexpr size_t reply_bytes = 8 * mib;
constexpr size_t header_bytes = 64 * kib;
/// Longest text of an engine, or of a program it runs, that people get.
constexpr size_t status_bytes = 2 * kib;

} // namespace engine

} // namespace roscell::limits
