#include "actors/edge/engine/image_folder.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

using document = json;

constexpr const char* manifest_name = "manifest.json";

/// What `docker save` says of an image, as far as it counts here.
struct saved_image {
  std::string config;              ///< A path in the archive.
  std::vector<std::string> layers; ///< The same, from the bottom.
  bool has_names = false;
};

edge_error odd_archive(const std::string& why) {
  return {error_code::engine_failed,
          "the container engine saves the image " + why,
          "images of engines that keep them in containerd's store do not "
          "travel: pull it there, or have a registry of your own"};
}

edge_error not_promised(const std::string& why) {
  return {error_code::schema_violation,
          "what has come is not the image that was promised: " + why, ""};
}

/// Null for what is no document, or is deeper than any of an image.
document read_json(const std::string& text) {
  document_limits bounds;
  bounds.max_bytes = limits::engine::image_config_bytes;
  bounds.max_name_bytes = 4 * limits::kib;
  auto result = parse_document(text, bounds);
  auto* known = std::get_if<json>(&result);
  return known == nullptr ? document{} : std::move(*known);
}

/// All texts of a list; nothing if it is none, or holds anything else.
std::optional<std::vector<std::string>> texts_of(const document& list) {
  if (!list.is_array())
    return std::nullopt;
  std::vector<std::string> result;
  for (const auto& x : list) {
    if (!x.is_string())
      return std::nullopt;
    result.push_back(x.get<std::string>());
  }
  return result;
}

std::optional<saved_image> read_manifest(const fs::path& folder) {
  const auto text = read_small_file(folder / manifest_name,
                                    limits::engine::image_config_bytes);
  const auto list = text ? read_json(*text) : document{};
  if (!list.is_array() || list.size() != 1 || !list.front().is_object())
    return std::nullopt;
  const auto& image = list.front();
  const auto config = image.find("Config");
  const auto layers = image.find("Layers");
  if (config == image.end() || !config->is_string() || layers == image.end())
    return std::nullopt;
  auto paths = texts_of(*layers);
  if (!paths)
    return std::nullopt;
  const auto names = image.find("RepoTags");
  return saved_image{config->get<std::string>(), std::move(*paths),
                     names != image.end() && !names->empty()};
}

/// Of an image's config; nothing if it is none.
std::optional<std::vector<std::string>> diff_ids_in(const document& config) {
  const auto root = config.is_object() ? config.find("rootfs") : config.end();
  if (root == config.end() || !root->is_object()
      || root->find("diff_ids") == root->end())
    return std::nullopt;
  auto result = texts_of(*root->find("diff_ids"));
  return result && std::all_of(result->begin(), result->end(), is_image_id)
             ? result
             : std::nullopt;
}

/// "sha256:DIGITS" as the name of a file.
std::string file_of(const std::string& id, const char* suffix) {
  return id.substr(id.find(':') + 1) + suffix;
}

std::vector<std::string> layer_files(const std::vector<std::string>& diff_ids) {
  std::vector<std::string> result;
  result.reserve(diff_ids.size());
  for (const auto& x : diff_ids)
    result.push_back(file_of(x, ".tar"));
  return result;
}

/// A file of the archive, wherever its links lead inside of it.
std::optional<fs::path> find_inside(const fs::path& folder,
                                    const std::string& name) {
  std::error_code error;
  const auto root = fs::canonical(folder, error);
  const auto path = error ? fs::path{} : fs::canonical(folder / name, error);
  const auto way = path.lexically_relative(root);
  if (error || way.empty() || *way.begin() == ".."
      || !fs::is_regular_file(path, error))
    return std::nullopt;
  return path;
}

std::optional<edge_error> move_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error)
    return std::nullopt;
  return edge_error{error_code::internal,
                    "cannot write '" + to.string() + "': " + error.message(),
                    ""};
}

/// Layers may be there twice, with one file.
std::optional<edge_error> move_layers(const fs::path& unpacked,
                                      const fs::path& folder,
                                      const saved_image& image,
                                      const std::vector<std::string>& names,
                                      size_t layers_there) {
  std::error_code error;
  for (size_t i = layers_there; i < names.size(); ++i) {
    if (fs::exists(folder / names[i], error))
      continue;
    const auto file = find_inside(unpacked, image.layers[i]);
    if (!file)
      return odd_archive("without one of its layers");
    if (auto why = move_file(*file, folder / names[i]))
      return why;
  }
  return std::nullopt;
}

std::optional<edge_error>
write_manifest(const fs::path& folder, const std::string& config,
               const std::vector<std::string>& layers) {
  const document text{
      {{"Config", config}, {"RepoTags", nullptr}, {"Layers", layers}}};
  std::ofstream file{folder / manifest_name, std::ios::binary};
  file << text.dump() << std::flush;
  if (file)
    return std::nullopt;
  return edge_error{error_code::internal,
                    "cannot write '" + (folder / manifest_name).string() + "'",
                    ""};
}

} // namespace

std::optional<edge_error> make_image_folder(const fs::path& unpacked,
                                            const fs::path& folder,
                                            const std::string& id,
                                            size_t layers_there) {
  const auto image = read_manifest(unpacked);
  if (!image)
    return odd_archive("without a manifest that can be read");
  const auto config = find_inside(unpacked, image->config);
  const auto text =
      config ? read_small_file(*config, limits::engine::image_config_bytes)
             : std::nullopt;
  if (!text || "sha256:" + sha256_hex(*text) != id)
    return odd_archive("with another config than its id says");
  const auto diff_ids = diff_ids_in(read_json(*text));
  if (!diff_ids || diff_ids->size() != image->layers.size())
    return odd_archive("with a config that names other layers");
  std::error_code error;
  fs::create_directories(folder, error);
  const auto names = layer_files(*diff_ids);
  if (auto why = move_layers(unpacked, folder, *image, names, layers_there))
    return why;
  if (auto why = move_file(*config, folder / file_of(id, ".json")))
    return why;
  return write_manifest(folder, file_of(id, ".json"), names);
}

edge_result<std::vector<std::string>>
check_image_folder(const fs::path& folder, const std::string& id) {
  const auto image = read_manifest(folder);
  const auto config = file_of(id, ".json");
  if (!image || image->has_names || image->config != config)
    return not_promised("its manifest is of another one");
  const auto text =
      read_small_file(folder / config, limits::engine::image_config_bytes);
  if (!text || "sha256:" + sha256_hex(*text) != id)
    return not_promised("its config has another hash");
  const auto diff_ids = diff_ids_in(read_json(*text));
  if (!diff_ids || image->layers != layer_files(*diff_ids))
    return not_promised("its layers are not those of its config");
  std::set<std::string> expected{manifest_name, config};
  expected.insert(image->layers.begin(), image->layers.end());
  std::vector<std::string> result{manifest_name};
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error)) {
    const auto name = i->path().filename().string();
    if (expected.count(name) == 0 || i->is_symlink() || !i->is_regular_file())
      return not_promised("there is '" + name + "' in it");
    if (name != manifest_name)
      result.push_back(name);
  }
  std::sort(result.begin() + 1, result.end());
  return result;
}

} // namespace roscell
