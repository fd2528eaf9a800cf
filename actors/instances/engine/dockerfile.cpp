#include "actors/instances/engine/dockerfile.hpp"

#include "actors/edge/io/crypto.hpp"
#include "messages/codec/json_codec.hpp"

namespace roscell {

namespace {

/// Marks the hash as this use's own.
constexpr std::string_view hash_key = "roscell image";

constexpr size_t tag_digits = 32;

/// JSON in one line, whatever bytes are in it.
std::string in_one_line(const json& value) {
  return value.dump(-1, ' ', true, json::error_handler_t::replace);
}

json program_in_image(const image_recipe& recipe) {
  json result = recipe.entry_point;
  result[0] = std::string{image_skill_dir} + '/' + recipe.entry_point.at(0);
  return result;
}

/// A path component of an image name: lower-case letters and digits, with
/// single separators between them.
std::string repository_of(const std::string& operation) {
  std::string result;
  for (const char c : operation) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      result += upper ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  if (!result.empty() && result.back() == '_')
    result.pop_back();
  return result.empty() ? "skill" : result;
}

} // namespace

std::string dockerfile_of(const image_recipe& recipe) {
  std::string text = "FROM " + recipe.base_image + "\n";
  // One line each; a name with a line feed must not become an instruction.
  for (const auto& x : recipe.libraries)
    text += "# " + in_one_line(x.name) + " is " + in_one_line(x.file.string())
            + ", " + std::to_string(x.bytes) + " bytes of "
            + std::to_string(x.modified_unix_s) + "\n";
  text += "COPY opt /opt\n";
  if (!recipe.libraries.empty())
    text += std::string{"ENV LD_LIBRARY_PATH="} + image_library_dir + "\n";
  text += std::string{"WORKDIR "} + image_skill_dir + "\n";
  text += "LABEL roscell.skill=" + recipe.skill + "\n";
  if (!recipe.entry_point.empty())
    text += "ENTRYPOINT " + in_one_line(program_in_image(recipe)) + "\n";
  return text;
}

std::string image_name(const std::string& operation,
                       const std::string& dockerfile) {
  return "roscell/" + repository_of(operation) + ':'
         + to_hex(hmac_sha256(hash_key, dockerfile)).substr(0, tag_digits);
}

} // namespace roscell
