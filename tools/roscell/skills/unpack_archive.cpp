#include "tools/roscell/skills/unpack_archive.hpp"

#include "actors/edge/host/own_process.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "schemas/document.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <unistd.h>

#include <chrono>
#include <string>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

constexpr const char* program_name = "roscell-unpack-skill";

command_error cannot_unpack(const std::string& why, const std::string& hint) {
  return command_error{exit_refused, why, hint};
}

/// What the program prints; empty if it cannot be run.
std::string output_of(const std::filesystem::path& path,
                      const std::filesystem::path& archive,
                      const std::filesystem::path& into) {
  constexpr std::chrono::minutes patience{10};
  constexpr size_t most_bytes = 64 * 1024;
  const program unpacker{path.string(), {archive.string(), into.string()}, {}};
  auto said = run_program(unpacker, patience, most_bytes);
  auto* text = std::get_if<std::string>(&said);
  return text == nullptr ? std::string{} : std::move(*text);
}

} // namespace

std::filesystem::path unpack_archive(const std::filesystem::path& archive,
                                     const std::filesystem::path& into) {
  const auto unpacker = find_private(program_folder(), program_name);
  if (::access(unpacker.c_str(), X_OK) != 0)
    throw cannot_unpack("archives are unpacked by " + std::string{program_name}
                            + ", which is not installed",
                        "install libroscell-dev, in a build tree build "
                        "unpack_skill, or unpack '"
                            + printable(archive.string())
                            + "' and name its folder");
  const auto said = parse_document(output_of(unpacker, archive, into));
  const auto* answer = std::get_if<json>(&said);
  if (answer == nullptr || !answer->is_object())
    throw cannot_unpack("'" + printable(archive.string())
                            + "' cannot be unpacked: " + program_name
                            + " has failed",
                        "unpack it, and name its folder");
  if (const auto folder = answer->value("folder", std::string{});
      !folder.empty())
    return folder;
  throw cannot_unpack(printable(answer->value("message", std::string{})),
                      printable(answer->value("hint", std::string{})));
}

} // namespace roscell::cli
