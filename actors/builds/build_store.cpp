#include "actors/builds/build_store.hpp"

#include "actors/builds/limits.hpp"
#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/build_pieces.hpp"
#include "actors/edge/limit_units.hpp"

#include <algorithm>
#include <array>
#include <system_error>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 3> places{"skills", "kept", "unfinished"};

} // namespace

build_store::build_store(fs::path folder, uint64_t most_bytes,
                         std::function<bool(const fs::path&)> runs_here)
    : folder_(std::move(folder)), most_bytes_(most_bytes),
      runs_here_(std::move(runs_here)), records_(folder_ / "about") {
  std::error_code ignored;
  for (const auto* place : places)
    fs::create_directories(folder_ / place, ignored);
  for (auto& x : records_.read_all())
    take_up(std::move(x));
  remove_leftovers();
}

fs::path build_store::skills_in(const fs::path& folder) {
  return folder / "skills";
}

fs::path build_store::kept_in(const fs::path& folder) {
  return folder / "kept";
}

/// After a start: what is whole was checked before it came to its place, and
/// of the others each piece is.
void build_store::take_up(stored_build build) {
  const auto& hash = build.name.hash;
  std::error_code error;
  build.used = fs::is_directory(skills_in(folder_) / hash, error);
  build.whole = build.used || fs::is_directory(kept_in(folder_) / hash, error);
  const auto manifest = records_.manifest_of(build.name);
  if (std::holds_alternative<edge_error>(manifest))
    return records_.forget(hash);
  const auto& pieces = *std::get<const build_manifest*>(manifest);
  build.pieces = build.whole ? std::vector<bool>(pieces.pieces.size(), true)
                             : find_pieces(place_of(build), pieces);
  builds_[hash] = std::move(build);
}

/// What no record tells of: a build that was being dropped when the power went
/// would be taken for a skill of this node.
void build_store::remove_leftovers() {
  std::error_code error;
  std::vector<fs::path> gone;
  for (const auto* place : places)
    for (fs::directory_iterator i{folder_ / place, error}, end;
         !error && i != end; i.increment(error)) {
      const auto* known = find(i->path().filename().string());
      if (known == nullptr || place_of(*known) != i->path())
        gone.push_back(i->path());
    }
  for (const auto& x : gone)
    fs::remove_all(x, error);
}

edge_result<stored_build>
build_store::offer(const build_name& name, const std::string& manifest,
                   const std::string& cell, const std::set<std::string>& in_use,
                   int64_t now_unix_ms) {
  if (const auto* known = find(name.hash);
      known != nullptr
      && (known->whole || known->name.manifest == name.manifest)) {
    touch(name.hash, now_unix_ms);
    return builds_.at(name.hash);
  }
  const auto read = parse_manifest(manifest, name);
  if (const auto* why = std::get_if<edge_error>(&read))
    return *why;
  // A part of it that came by another text of its manifest.
  if (auto why = drop(name.hash))
    return std::move(*why);
  for (const auto& hash : in_use)
    touch(hash, now_unix_ms);
  if (auto why = make_room(static_cast<uint64_t>(name.bytes), in_use))
    return std::move(*why);
  const auto& content = std::get<build_manifest>(read);
  stored_build build{name, std::vector<bool>(content.pieces.size(), false)};
  build.cell = cell;
  build.used_unix_ms = now_unix_ms;
  if (auto why = begin_build(place_of(build), content)) {
    std::error_code ignored;
    fs::remove_all(place_of(build), ignored);
    return std::move(*why);
  }
  if (auto why = records_.write(build, manifest))
    return std::move(*why);
  auto& stored = builds_[name.hash] = build;
  if (content.pieces.empty())
    return finish(stored, content);
  return stored;
}

edge_result<stored_build>
build_store::take(const fs::path& from, const build_name& name,
                  const std::string& manifest, const std::string& cell,
                  const std::set<std::string>& in_use, int64_t now_unix_ms) {
  std::error_code ignored;
  if (const auto* known = find(name.hash); known != nullptr && known->whole) {
    fs::remove_all(from, ignored);
    touch(name.hash, now_unix_ms);
    return builds_.at(name.hash);
  }
  stored_build build{name, {}};
  build.cell = cell;
  build.used_unix_ms = now_unix_ms;
  auto result = take_whole(from, std::move(build), manifest, in_use);
  fs::remove_all(from, ignored);
  return result;
}

/// The record comes first: what it tells of is found, or is begun anew.
edge_result<stored_build>
build_store::take_whole(const fs::path& from, stored_build build,
                        const std::string& manifest,
                        const std::set<std::string>& in_use) {
  const auto name = build.name;
  const auto read = parse_manifest(manifest, name);
  if (const auto* why = std::get_if<edge_error>(&read))
    return *why;
  // A part of it that is on its way.
  if (auto why = drop(name.hash))
    return std::move(*why);
  if (auto why = make_room(static_cast<uint64_t>(name.bytes), in_use))
    return std::move(*why);
  if (auto why = records_.write(build, manifest))
    return std::move(*why);
  build.whole = true;
  build.pieces.assign(std::get<build_manifest>(read).pieces.size(), true);
  std::error_code error;
  fs::rename(from, place_of(build), error);
  if (error)
    return cannot_write(place_of(build), error.message());
  return builds_[name.hash] = build;
}

edge_result<stored_build> build_store::write(const std::string& hash,
                                             size_t piece,
                                             std::string_view bytes) {
  const auto found = builds_.find(hash);
  if (found == builds_.end())
    return not_here(hash);
  auto& build = found->second;
  if (build.whole)
    return build;
  const auto manifest = records_.manifest_of(build.name);
  if (const auto* why = std::get_if<edge_error>(&manifest))
    return *why;
  const auto& content = *std::get<const build_manifest*>(manifest);
  if (auto why = write_piece(place_of(build), content, piece, bytes))
    return std::move(*why);
  build.pieces[piece] = true;
  if (std::find(build.pieces.begin(), build.pieces.end(), false)
      == build.pieces.end())
    return finish(build, content);
  return build;
}

const stored_build* build_store::find(const std::string& hash) const {
  const auto found = builds_.find(hash);
  return found == builds_.end() ? nullptr : &found->second;
}

edge_result<std::string>
build_store::manifest_text(const std::string& hash) const {
  return find(hash) == nullptr ? not_here(hash) : records_.manifest_text(hash);
}

edge_result<std::string> build_store::read(const std::string& hash,
                                           size_t piece) {
  const auto* build = find(hash);
  if (build == nullptr || piece >= build->pieces.size()
      || !build->pieces[piece])
    return not_here(hash);
  const auto manifest = records_.manifest_of(build->name);
  if (const auto* why = std::get_if<edge_error>(&manifest))
    return *why;
  return read_piece(place_of(*build),
                    *std::get<const build_manifest*>(manifest), piece);
}

std::optional<edge_error> build_store::pin(const std::string& hash, bool pinned,
                                           const std::string& cell) {
  const auto found = builds_.find(hash);
  if (found == builds_.end())
    return std::nullopt;
  auto& build = found->second;
  if (build.pinned == pinned && !build.cell.empty())
    return std::nullopt;
  build.pinned = pinned;
  if (build.cell.empty())
    build.cell = cell;
  return records_.write(build);
}

edge_result<stored_build> build_store::use(const std::string& hash,
                                           int64_t now_unix_ms) {
  const auto found = builds_.find(hash);
  if (found == builds_.end() || !found->second.whole)
    return not_here(hash);
  auto& build = found->second;
  touch(hash, now_unix_ms);
  if (build.used)
    return build;
  if (!runs_here_(place_of(build)))
    return edge_error{error_code::conflict,
                      "the build " + hash.substr(0, limits::build::shown_digits)
                          + " cannot run on this host",
                      "`roscell skills` shows what it was built for"};
  auto now = build;
  now.used = true;
  return move_to_place(build, now);
}

void build_store::touch(const std::string& hash, int64_t now_unix_ms) {
  const auto found = builds_.find(hash);
  if (found == builds_.end())
    return;
  found->second.used_unix_ms = now_unix_ms;
  // Where it cannot be written the order of what goes is that of before.
  records_.write(found->second);
}

std::optional<edge_error> build_store::drop(const std::string& hash) {
  const auto found = builds_.find(hash);
  if (found == builds_.end())
    return std::nullopt;
  std::error_code error;
  // First what makes it a build, so that none is left with half of its files.
  records_.forget(hash);
  const auto place = place_of(found->second);
  fs::remove_all(place, error);
  if (error)
    return cannot_write(place, error.message());
  records_.remove_manifest(hash);
  builds_.erase(found);
  return std::nullopt;
}

void build_store::leave_cells_but(const std::string& cell,
                                  const std::set<std::string>& in_use) {
  std::vector<std::string> gone;
  for (const auto& [hash, build] : builds_)
    if (build.cell != cell && in_use.count(hash) == 0)
      gone.push_back(hash);
  for (const auto& hash : gone)
    drop(hash);
}

const std::map<std::string, stored_build>& build_store::builds() const {
  return builds_;
}

uint64_t build_store::bytes() const {
  uint64_t result = 0;
  for (const auto& [hash, build] : builds_)
    result += static_cast<uint64_t>(build.name.bytes);
  return result;
}

fs::path build_store::place_of(const stored_build& build) const {
  const auto* where = !build.whole ? "unfinished"
                      : build.used ? "skills"
                                   : "kept";
  return folder_ / where / build.name.hash;
}

std::optional<edge_error>
build_store::make_room(uint64_t bytes, const std::set<std::string>& in_use) {
  std::vector<std::pair<int64_t, std::string>> may_go;
  uint64_t held = 0;
  for (const auto& [hash, build] : builds_) {
    if (build.pinned || in_use.count(hash) != 0)
      held += static_cast<uint64_t>(build.name.bytes);
    else
      may_go.emplace_back(build.used_unix_ms, hash);
  }
  if (held + bytes > most_bytes_)
    return edge_error{error_code::conflict,
                      "a build of " + std::to_string(bytes / limits::mib)
                          + " MiB has no place: "
                          + std::to_string(held / limits::mib) + " of the "
                          + std::to_string(most_bytes_ / limits::mib)
                          + " MiB for builds are in use",
                      "start the node with a larger --builds-bytes"};
  std::sort(may_go.begin(), may_go.end());
  for (const auto& [used, hash] : may_go) {
    if (this->bytes() + bytes <= most_bytes_)
      break;
    if (auto why = drop(hash))
      return why;
  }
  return std::nullopt;
}

/// It comes to its place by a rename, so that it is there whole or not at all.
edge_result<stored_build> build_store::finish(stored_build& build,
                                              const build_manifest& manifest) {
  const auto from = place_of(build);
  if (auto why = finish_build(from, manifest, build.name)) {
    if (why->code == error_code::conflict)
      drop(std::string{build.name.hash});
    return std::move(*why);
  }
  auto done = build;
  done.whole = true;
  return move_to_place(build, done);
}

edge_result<stored_build> build_store::move_to_place(stored_build& build,
                                                     stored_build changed) {
  std::error_code error;
  fs::rename(place_of(build), place_of(changed), error);
  if (error)
    return cannot_write(place_of(changed), error.message());
  build = std::move(changed);
  return build;
}

} // namespace roscell
