#pragma once

#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <string>
#include <vector>

/// Files that hold several documents. Pure.
namespace roscell::cli {

/// The documents of a YAML text, as `---` lines part them; those without a
/// value are left out. Before each stand as many line ends as there are lines
/// before it, so that places in it are those of the file.
std::vector<std::string> yaml_documents(const std::string& text);

/// What is wrong with a part of a document, with the places of the whole.
/// @param at JSON pointer of the part.
failure within(failure why, const std::string& at);

} // namespace roscell::cli
