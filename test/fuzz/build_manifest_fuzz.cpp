// Arbitrary bytes as the manifest of a build, under the name that they would
// have.
#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/io/crypto.hpp"
#include "schemas/document.hpp"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

using namespace roscell;

/// The name under which the manifest could be taken; none if it is no manifest.
static build_name name_of(std::string_view text) {
  const auto document = parse_document(text);
  const auto* known = std::get_if<json>(&document);
  if (known == nullptr)
    return {};
  const auto manifest = decode<build_manifest>(*known);
  const auto* read = std::get_if<build_manifest>(&manifest);
  if (read == nullptr)
    return {};
  return {hash_of(*read), sha256_hex(text),
          static_cast<int64_t>(bytes_of(*read))};
}

/// What is taken leads nowhere else, whatever the bytes are.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(bytes), size};
  const auto manifest = parse_manifest(text, name_of(text));
  const auto* taken = std::get_if<build_manifest>(&manifest);
  if (taken == nullptr)
    return 0;
  for (const auto& file : taken->files) {
    const auto path =
        (std::filesystem::path{"/skill"} / file.path).lexically_normal();
    if (path.string().compare(0, 7, "/skill/") != 0)
      std::abort();
    const auto target =
        (path.parent_path() / file.link).lexically_normal().string();
    if (!file.link.empty() && target.compare(0, 6, "/skill") != 0)
      std::abort();
  }
  return 0;
}
