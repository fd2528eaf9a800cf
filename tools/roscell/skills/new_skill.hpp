#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// A skill to begin with, outside of our tree: a CMake project of its own.
namespace roscell::cli {

struct new_file {
  std::string path; ///< Below the skill's folder.
  std::string text;
};

/// The files of template/, where names in '@' stand for what is not known yet.
/// Written by the build.
const std::vector<new_file>& embedded_template();

/// Whether a skill may be called so: words of lower-case letters and digits,
/// joined by '_', because it becomes a part of a C++ name; at most 63
/// characters.
bool is_skill_name(const std::string& name);

/// The nearest such name; empty if there is none.
std::string skill_name_for(const std::string& text);

/// The files of a new skill that will lie in `folder`, an absolute path.
std::vector<new_file> skill_files(const std::string& name,
                                  const std::filesystem::path& folder);

} // namespace roscell::cli
