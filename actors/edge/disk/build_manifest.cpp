#include "actors/edge/disk/build_manifest.hpp"

#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/disk/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Cuts a stream of bytes into pieces, and keeps the sum of each.
class piece_sums {
public:
  void add(std::string_view bytes) {
    while (!bytes.empty()) {
      if (!sum_)
        sum_ = std::make_unique<sha256_sum>();
      const auto part =
          std::min<uint64_t>(bytes.size(), build_piece_bytes - filled_);
      sum_->add(bytes.substr(0, part));
      bytes.remove_prefix(part);
      filled_ += part;
      if (filled_ == build_piece_bytes)
        end_piece();
    }
  }

  std::vector<std::string> end() {
    if (sum_)
      end_piece();
    return std::move(sums_);
  }

private:
  void end_piece() {
    sums_.push_back(sum_->hex());
    sum_.reset();
    filled_ = 0;
  }

  std::unique_ptr<sha256_sum> sum_;
  uint64_t filled_ = 0;
  std::vector<std::string> sums_;
};

build_file describe_file(const fs::path& folder, const fs::path& name,
                         piece_sums& pieces, uint64_t& bytes_left) {
  build_file result;
  result.path = name.string();
  const auto path = folder / name;
  if (is_link(path)) {
    result.link = link_target(folder, name);
    return result;
  }
  const auto file = open_plain_file(path);
  sha256_sum content;
  read_all(file, path, bytes_left, [&](std::string_view bytes) {
    content.add(bytes);
    pieces.add(bytes);
    result.bytes += static_cast<int64_t>(bytes.size());
  });
  result.program = file.program;
  result.sha256 = content.hex();
  return result;
}

edge_error bad_manifest(const std::string& why) {
  return {error_code::schema_violation, "the manifest of a build " + why,
          "add the skill again, from its folder"};
}

/// Whether a path is one that `list_files` would give.
bool stays_inside(const std::string& path) {
  const fs::path parts{path};
  return !path.empty() && path.size() <= limits::build::path_bytes
         && path.find('\0') == std::string::npos && !parts.is_absolute()
         && parts.lexically_normal() == parts && parts.has_filename()
         && *parts.begin() != "..";
}

/// The same for what the link of that path points to.
bool points_inside(const build_file& file) {
  const fs::path target{file.link};
  const auto real =
      (fs::path{file.path}.parent_path() / target).lexically_normal();
  return file.link.size() <= limits::build::path_bytes
         && file.link.find('\0') == std::string::npos && !target.is_absolute()
         && !real.empty() && *real.begin() != "..";
}

/// Why a file cannot be one of a build.
std::string file_problem(const build_file& file) {
  if (!stays_inside(file.path))
    return "names a path that leads out of the folder";
  if (file.link.empty())
    return file.bytes < 0 ? "says that a file has less than no bytes" : "";
  if (file.bytes != 0 || file.program || !file.sha256.empty())
    return "says of a link what only files have";
  return points_inside(file) ? "" : "has a link that leads out of the folder";
}

/// A file may not lie below another one, or below a link, which might lead
/// anywhere by the time that it is written.
std::string order_problem(const std::vector<build_file>& files) {
  std::set<std::string> leaves;
  for (size_t i = 0; i < files.size(); ++i) {
    if (i > 0 && files[i].path <= files[i - 1].path)
      return "does not name its files in their order";
    leaves.insert(files[i].path);
  }
  for (const auto& x : files)
    for (auto above = fs::path{x.path}.parent_path(); !above.empty();
         above = above.parent_path())
      if (leaves.count(above.string()) != 0)
        return "names files below something that is no folder";
  return {};
}

std::string manifest_problem(const build_manifest& manifest,
                             const build_name& name,
                             const folder_limits& limits) {
  if (manifest.files.size() > limits.max_files)
    return "names too many files";
  uint64_t bytes = 0;
  for (const auto& x : manifest.files) {
    if (auto why = file_problem(x); !why.empty())
      return why;
    bytes += static_cast<uint64_t>(x.bytes);
    if (bytes > limits.max_bytes)
      return "is that of too large a build";
  }
  if (auto why = order_problem(manifest.files); !why.empty())
    return why;
  if (bytes != static_cast<uint64_t>(name.bytes)
      || manifest.pieces.size()
             != (bytes + build_piece_bytes - 1) / build_piece_bytes)
    return "does not fit the size of its build";
  return hash_of(manifest) == name.hash ? "" : "is that of another build";
}

} // namespace

edge_result<described_build> describe_folder(const fs::path& folder,
                                             const folder_limits& limits) {
  try {
    described_build result;
    piece_sums pieces;
    auto bytes_left = limits.max_bytes;
    for (const auto& name : list_files(folder, limits))
      result.manifest.files.push_back(
          describe_file(folder, name, pieces, bytes_left));
    result.manifest.pieces = pieces.end();
    json document;
    to_json(document, result.manifest);
    result.text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    result.name = {hash_of(result.manifest), sha256_hex(result.text),
                   static_cast<int64_t>(bytes_of(result.manifest))};
    // What cannot be sent as it is, a name that is no text, shows here.
    if (auto read = parse_manifest(result.text, result.name, limits);
        auto* why = std::get_if<edge_error>(&read))
      return std::move(*why);
    return result;
  } catch (const folder_failure& failure) {
    return failure.why;
  }
}

edge_result<build_manifest> parse_manifest(std::string_view text,
                                           const build_name& name,
                                           const folder_limits& limits) {
  document_limits bounds;
  bounds.max_bytes = limits::build::manifest_bytes;
  bounds.max_values = limits::build::manifest_values;
  if (sha256_hex(text) != name.manifest)
    return bad_manifest("is not what its hash says");
  auto document = parse_document(text, bounds);
  if (const auto* why = std::get_if<failure>(&document))
    return bad_manifest("cannot be read: " + why->message);
  if (const auto why =
          validate_document("build_manifest", std::get<json>(document)))
    return bad_manifest("is wrong at " + why->where + ": " + why->message);
  auto manifest = decode<build_manifest>(std::get<json>(document));
  if (const auto* why = std::get_if<failure>(&manifest))
    return bad_manifest(why->message);
  auto& result = std::get<build_manifest>(manifest);
  if (const auto why = manifest_problem(result, name, limits); !why.empty())
    return bad_manifest(why);
  return std::move(result);
}

std::string hash_of(const build_manifest& manifest) {
  folder_sum sum;
  for (const auto& x : manifest.files) {
    if (x.link.empty())
      sum.add_file(x.path, x.program, x.sha256);
    else
      sum.add_link(x.path, x.link);
  }
  return sum.hex();
}

uint64_t bytes_of(const build_manifest& manifest) {
  uint64_t result = 0;
  for (const auto& x : manifest.files)
    result += static_cast<uint64_t>(x.bytes);
  return result;
}

uint64_t piece_size(const build_manifest& manifest, size_t piece) {
  const auto begin = piece * build_piece_bytes;
  return std::min(build_piece_bytes, bytes_of(manifest) - begin);
}

} // namespace roscell
