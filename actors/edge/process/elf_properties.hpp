#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// What a compiled program says of itself.
struct elf_properties {
  /// What it is for, as container images name it; empty for another machine.
  std::string architecture;
  /// It certainly loads no library. The dynamic linker crashes when it is asked
  /// what such a program loads.
  bool is_static = false;
  /// The program that the system starts for it, its dynamic linker; empty if it
  /// has none, or says so behind the first bytes.
  std::string interpreter;
};

/// Reads the first bytes of a file, which may be anything. None unless they
/// begin as a compiled program or library does; of a damaged one, or one of
/// another byte order than this host's, nothing else is known.
std::optional<elf_properties> parse_elf(std::string_view bytes);

/// The same for a file; none, too, if it cannot be read. Blocks on the disk.
std::optional<elf_properties> read_elf(const std::filesystem::path& file);

} // namespace roscell
