#include "actors/builds/build_records.hpp"

#include "actors/builds/limits.hpp"
#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/limits.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "schemas/document.hpp"

#include <system_error>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr const char* manifest_suffix = ".manifest";
constexpr const char* about_suffix = ".json";

bool is_hash(const std::string& text) {
  constexpr size_t digits = 64;
  return text.size() == digits
         && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// What `write_about` has written; nothing if it cannot be read.
std::optional<json> read_about(const fs::path& file) {
  const auto text = read_small_file(file, limits::build::about_bytes);
  if (!text)
    return std::nullopt;
  auto document = parse_document(*text);
  auto* result = std::get_if<json>(&document);
  return result != nullptr && result->is_object()
             ? std::optional{std::move(*result)}
             : std::nullopt;
}

/// Throws json::exception where a member is of another kind.
stored_build from_about(const std::string& hash, const json& about) {
  stored_build result;
  result.name.hash = hash;
  result.name.manifest = about.value("manifest", std::string{});
  result.name.bytes = about.value("bytes", int64_t{0});
  result.cell = about.value("cell", std::string{});
  result.pinned = about.value("pinned", false);
  result.used_unix_ms = about.value("used_unix_ms", int64_t{0});
  return result;
}

} // namespace

edge_error not_here(const std::string& hash) {
  return {error_code::conflict,
          "the build " + hash.substr(0, limits::build::shown_digits)
              + " is not on this node",
          ""};
}

edge_error cannot_write(const fs::path& path, const std::string& why) {
  return {error_code::internal, "cannot write '" + path.string() + "': " + why,
          ""};
}

build_records::build_records(fs::path folder) : folder_(std::move(folder)) {
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
}

std::vector<stored_build> build_records::read_all() const {
  std::vector<stored_build> result;
  std::error_code error;
  for (fs::directory_iterator i{folder_, error}, end; !error && i != end;
       i.increment(error)) {
    const auto hash = i->path().stem().string();
    const auto about = i->path().extension() == about_suffix && is_hash(hash)
                           ? read_about(i->path())
                           : std::nullopt;
    if (!about)
      continue;
    try {
      result.push_back(from_about(hash, *about));
    } catch (const json::exception&) {
      continue;
    }
  }
  return result;
}

std::optional<edge_error>
build_records::write(const stored_build& build,
                     const std::string& manifest) const {
  const auto path = file(build.name.hash, manifest_suffix);
  if (const auto why = write_lasting(path, manifest); !why.empty())
    return cannot_write(path, why);
  return write(build);
}

std::optional<edge_error>
build_records::write(const stored_build& build) const {
  const json text{{"manifest", build.name.manifest},
                  {"bytes", build.name.bytes},
                  {"cell", build.cell},
                  {"pinned", build.pinned},
                  {"used_unix_ms", build.used_unix_ms}};
  const auto path = file(build.name.hash, about_suffix);
  const auto why = write_lasting(path, text.dump());
  return why.empty() ? std::nullopt : std::optional{cannot_write(path, why)};
}

void build_records::forget(const std::string& hash) const {
  std::error_code ignored;
  fs::remove(file(hash, about_suffix), ignored);
}

void build_records::remove_manifest(const std::string& hash) {
  std::error_code ignored;
  fs::remove(file(hash, manifest_suffix), ignored);
  manifests_.remove_if([&](const auto& x) { return x.first == hash; });
}

edge_result<std::string>
build_records::manifest_text(const std::string& hash) const {
  auto text = read_small_file(file(hash, manifest_suffix),
                              limits::build::manifest_bytes);
  if (!text)
    return not_here(hash);
  return std::move(*text);
}

edge_result<const build_manifest*>
build_records::manifest_of(const build_name& name) {
  for (const auto& x : manifests_)
    if (x.first == name.hash)
      return &x.second;
  const auto text = manifest_text(name.hash);
  if (const auto* why = std::get_if<edge_error>(&text))
    return *why;
  auto read = parse_manifest(std::get<std::string>(text), name);
  if (const auto* why = std::get_if<edge_error>(&read))
    return *why;
  manifests_.emplace_front(name.hash,
                           std::get<build_manifest>(std::move(read)));
  if (manifests_.size() > limits::build::manifests_in_memory)
    manifests_.pop_back();
  return &manifests_.front().second;
}

fs::path build_records::file(const std::string& hash,
                             const char* suffix) const {
  return folder_ / (hash + suffix);
}

} // namespace roscell
