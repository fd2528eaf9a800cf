#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/new_skill.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

command_error cannot_make(const fs::path& path, const std::string& why) {
  return {exit_usage, "cannot make '" + printable(path.string()) + "': " + why,
          "go to a folder in which you may write"};
}

void check_name(const std::string& name) {
  if (is_skill_name(name))
    return;
  const auto near = skill_name_for(name);
  throw command_error{
      exit_usage, "'" + printable(name) + "' is no name for a skill",
      "lower-case letters, digits and '_', the first a letter, at most 63 of "
      "them"
          + (near.empty() ? "" : "; such as " + near)};
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::create_directory(folder, error))
    return;
  if (!error || error == std::errc::file_exists)
    throw command_error{exit_usage,
                        "there is '" + printable(folder.string())
                            + "' already, and it stays as it is",
                        "take another name, or go to another folder"};
  throw cannot_make(folder, error.message());
}

void write_file(const fs::path& path, const std::string& text) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error)
    throw cannot_make(path, error.message());
  std::ofstream file{path};
  file << text << std::flush;
  if (!file)
    throw cannot_make(path, "it cannot be written");
}

int make_skill(const std::string& name) {
  check_name(name);
  std::error_code error;
  const auto folder = fs::absolute(name, error);
  if (error)
    throw cannot_make(name, error.message());
  make_folder(folder);
  for (const auto& file : skill_files(name, folder)) {
    write_file(folder / file.path, file.text);
    print(name + "/" + file.path + "\n");
  }
  print_note("next: cd " + name + " && cmake --workflow --preset default");
  return exit_done;
}

} // namespace

void add_skill_new_command(CLI::App& skills, action& chosen) {
  auto name = std::make_shared<std::string>();
  auto* command = skills.add_subcommand(
      "new", "Generate a folder with a new skill, in C++.");
  command->footer(
      "Makes a folder NAME here with a class, its descriptor, what CMake "
      "needs, "
      "a test with\nframes from a file, and a task. It builds against an "
      "installed ROSCell; where that is not\nin /usr, say where: export "
      "CMAKE_PREFIX_PATH=DIR.\n\n"
      "Examples:\n  roscell skill new shout && cd shout\n"
      "  cmake --workflow --preset default\n"
      "  roscell skill check build/skills/shout");
  command
      ->add_option("NAME", *name,
                   "What it does, in one word: it names the operation")
      ->required()
      ->option_text(" ");
  command->callback(
      [&chosen, name] { chosen = [name] { return make_skill(*name); }; });
}

} // namespace roscell::cli
