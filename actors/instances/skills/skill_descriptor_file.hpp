#pragma once

#include "messages/skill.hpp"
#include "schemas/document.hpp"
#include "schemas/validator.hpp"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

/// The file in a skill folder that describes the skill: JSON, or YAML.
namespace roscell {

/// The files of `folder` that are called as descriptors are: `skill.json`,
/// `skill.yaml`, `skill.yml`. A skill has exactly one of them.
std::vector<std::filesystem::path>
descriptor_files(const std::filesystem::path& folder);

/// The one that errors name: the first, or `skill.json` if there is none yet.
std::filesystem::path descriptor_of(const std::filesystem::path& folder);

/// What a descriptor says its program is, whatever else is wrong with it; empty
/// if it says none, or none that can be looked at.
std::vector<std::string> entry_point_in(const std::filesystem::path& file);

/// The descriptor in a file, or all that is wrong with it, with line and column
/// in words.
std::variant<skill_descriptor, std::vector<schema_error>>
read_descriptor(const std::filesystem::path& file);

/// The same in a text.
std::variant<skill_descriptor, std::vector<schema_error>>
parse_descriptor(const std::string& text, document_format format);

} // namespace roscell
