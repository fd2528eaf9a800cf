#include "actors/edge/engine/image_reference.hpp"

#include "actors/edge/http/http_target.hpp"

namespace roscell {

namespace {

constexpr std::string_view digest_begin = "sha256:";
constexpr size_t digest_digits = 64;
/// Of a digest that is part of a tag.
constexpr size_t pinned_digits = 32;

bool is_registry(std::string_view part) {
  return part == "localhost" || part.find('.') != std::string_view::npos
         || part.find(':') != std::string_view::npos;
}

} // namespace

bool is_image_id(std::string_view text) {
  return text.size() == digest_begin.size() + digest_digits
         && text.substr(0, digest_begin.size()) == digest_begin
         && text.find_first_not_of("0123456789abcdef", digest_begin.size())
                == std::string_view::npos;
}

image_reference parse_image_reference(std::string_view text) {
  image_reference result;
  if (is_image_id(text)) {
    result.id = text;
    return result;
  }
  const auto at = text.find('@');
  if (at != std::string_view::npos)
    result.digest = text.substr(at + 1);
  text = text.substr(0, at);
  // A colon before the last slash is that of a registry's port.
  const auto slash = text.rfind('/');
  const auto colon =
      text.find(':', slash == std::string_view::npos ? 0 : slash);
  if (colon != std::string_view::npos)
    result.tag = text.substr(colon + 1);
  else if (result.digest.empty())
    result.tag = "latest";
  result.name = text.substr(0, colon);
  const auto first = result.name.find('/');
  if (first != std::string::npos && is_registry(result.name.substr(0, first))) {
    result.registry = result.name.substr(0, first);
    result.repository = result.name.substr(first + 1);
  } else {
    result.registry = "docker.io";
    result.repository =
        (first == std::string::npos ? "library/" : "") + result.name;
  }
  return result;
}

std::string image_path(std::string_view image) {
  constexpr std::string_view plain = "/:@";
  std::string result;
  for (const char& c : image)
    if (plain.find(c) != std::string_view::npos)
      result += c;
    else
      result += percent_encode({&c, 1});
  return result;
}

std::string name_in_engine(const std::string& image) {
  const auto digest = parse_image_reference(image).digest;
  return is_image_id(digest)
             ? "roscell-pinned:"
                   + digest.substr(digest_begin.size(), pinned_digits)
             : image;
}

} // namespace roscell
