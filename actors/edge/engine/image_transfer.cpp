#include "actors/edge/engine/image_transfer.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/image_folder.hpp"
#include "actors/edge/engine/image_layers.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/process_spawner.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

std::string in_mib(uint64_t bytes) {
  return std::to_string(bytes / limits::mib) + " MiB";
}

edge_error disk_failure(const fs::path& path, const std::string& why) {
  return {error_code::internal, "cannot write '" + path.string() + "': " + why,
          "free space on the disk of the data directory"};
}

/// Nothing where there is room for so much in a folder.
std::optional<edge_error> room_problem(const fs::path& folder, uint64_t bytes) {
  std::error_code error;
  const auto space = fs::space(folder, error);
  if (error || space.available >= bytes + limits::engine::spare_bytes)
    return std::nullopt;
  return edge_error{error_code::conflict,
                    "an image needs " + in_mib(bytes) + " in '"
                        + folder.string() + "', where "
                        + in_mib(space.available) + " are free",
                    "free space on the disk of the data directory"};
}

edge_error too_large(const std::string& id, uint64_t most) {
  return {error_code::conflict,
          "the image " + id + " is larger than the " + in_mib(most)
              + " for builds",
          "start the node with a larger --builds-bytes"};
}

/// Debian's own tar; what it reads and writes comes from engines of this host.
std::optional<edge_error> run_tar(std::vector<std::string> arguments) {
  constexpr size_t words = 4 * limits::kib;
  const program tar{"/bin/tar", std::move(arguments), {{"LC_ALL", "C"}}};
  const auto done = run_program(tar, limits::engine::image_tar, words);
  if (const auto* why = std::get_if<edge_error>(&done))
    return *why;
  return std::nullopt;
}

http_client client_of(const engine_door& door) {
  http_endpoint to;
  to.socket_path = door.socket;
  return http_client{to};
}

/// The engine's archive of an image, as a file.
std::optional<edge_error> download_image(const engine_door& door,
                                         const image_saving& what,
                                         const fs::path& file) {
  const unique_fd fd{::open(file.c_str(),
                            O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                            S_IRUSR | S_IWUSR)};
  if (!fd)
    return disk_failure(file, std::strerror(errno));
  uint64_t bytes = 0;
  std::optional<edge_error> problem;
  const auto answer = client_of(door).download(
      api_path(door, "/images/" + what.id + "/get"),
      [&](std::string_view part) {
        bytes += part.size();
        if (bytes > what.most_bytes)
          problem = too_large(what.id, what.most_bytes);
        else if (!write_whole(fd.get(), part))
          problem = disk_failure(file, std::strerror(errno));
        return !problem;
      },
      within(door, limits::engine::save));
  if (problem)
    return problem;
  if (const auto* why = std::get_if<edge_error>(&answer))
    return *why;
  const auto& reply = std::get<http_reply>(answer);
  if (const engine_reply x{reply.status, reply.body}; !x.ok())
    return engine_refusal("the container engine cannot save an image", x);
  return std::nullopt;
}

/// The image's archive, unpacked in `into`.
std::optional<edge_error> unpack_image(const engine_door& door,
                                       const image_saving& what,
                                       const fs::path& into) {
  const auto file = what.work_dir / "saved.tar";
  if (auto why = download_image(door, what, file))
    return why;
  std::error_code error;
  fs::create_directories(into, error);
  if (auto why =
          run_tar({"--extract", "--file", file.string(), "--directory",
                   into.string(), "--no-same-owner", "--no-same-permissions"}))
    return disk_failure(into, why->message);
  fs::remove(file, error);
  return std::nullopt;
}

} // namespace

edge_result<image_in_folder> save_image_of(const engine_door& door,
                                           const image_saving& what) {
  const auto known = inspect_image(door, what.id);
  if (const auto* why = std::get_if<edge_error>(&known))
    return *why;
  const auto& image = std::get<std::optional<engine_image>>(known);
  if (!image)
    return edge_error{error_code::conflict,
                      "the container engine does not know the image " + what.id,
                      ""};
  const auto bytes = static_cast<uint64_t>(image->bytes);
  if (bytes > what.most_bytes)
    return too_large(what.id, what.most_bytes);
  // The archive, and what is unpacked of it.
  if (auto why = room_problem(what.work_dir, 2 * bytes))
    return std::move(*why);
  const auto unpacked = what.work_dir / "unpacked";
  if (auto why = unpack_image(door, what, unpacked))
    return std::move(*why);
  image_in_folder result;
  result.folder = what.work_dir / "image";
  if (auto why = make_image_folder(unpacked, result.folder, what.id,
                                   layers_there(image->layers, what.chains)))
    return std::move(*why);
  std::error_code ignored;
  fs::remove_all(unpacked, ignored);
  auto build = describe_folder(result.folder);
  if (auto* why = std::get_if<edge_error>(&build))
    return std::move(*why);
  result.build = std::get<described_build>(std::move(build));
  return result;
}

namespace {

/// What the engine complains of in a reply that is good; empty: of nothing.
std::string complaint_in(const std::string& body) {
  std::istringstream lines{body};
  for (std::string line; std::getline(lines, line);) {
    const auto said = nlohmann::json::parse(line, nullptr, false);
    const auto why = said.is_object() ? said.find("error") : said.end();
    if (said.is_object() && why != said.end() && why->is_string())
      return why->get<std::string>();
  }
  return {};
}

/// The id of what a load has given, as far as the engine tells it.
std::string loaded_id(const std::string& body) {
  const auto begin = body.find("sha256:");
  const auto id =
      begin == std::string::npos ? std::string{} : body.substr(begin, 71);
  return is_image_id(id) ? id : std::string{};
}

std::optional<edge_error>
upload_image(const engine_door& door, const fs::path& file, std::string& said) {
  const auto answer =
      client_of(door).send_file(api_path(door, "/images/load?quiet=1"), file,
                                within(door, limits::engine::load));
  if (const auto* why = std::get_if<edge_error>(&answer))
    return *why;
  const auto& reply = std::get<http_reply>(answer);
  const std::string what = "the container engine cannot load an image";
  if (const engine_reply x{reply.status, reply.body}; !x.ok())
    return engine_refusal(what, x);
  said = reply.body;
  if (const auto complaint = complaint_in(reply.body); !complaint.empty())
    return engine_refusal(what, {reply.status, complaint});
  return std::nullopt;
}

/// That the engine knows now what was promised.
std::optional<edge_error> check_loaded(const engine_door& door,
                                       const std::string& id,
                                       const std::string& said) {
  const auto known = inspect_image(door, id);
  if (const auto* why = std::get_if<edge_error>(&known))
    return *why;
  const auto& image = std::get<std::optional<engine_image>>(known);
  if (image && image->id == id)
    return std::nullopt;
  const auto other = loaded_id(said);
  if (!other.empty())
    ask_engine_now(door, "DELETE", "/images/" + other,
                   "the image cannot be removed");
  return edge_error{error_code::schema_violation,
                    "the container engine has loaded "
                        + (other.empty() ? "another image" : other) + " where "
                        + id + " was promised; it is removed",
                    ""};
}

std::optional<edge_error> name_image(const engine_door& door,
                                     const std::string& id,
                                     const std::string& image) {
  const auto name = parse_image_reference(name_in_engine(image));
  if (!name.id.empty())
    return std::nullopt;
  const auto answer =
      ask_engine_now(door, "POST",
                     "/images/" + id + "/tag?repo=" + percent_encode(name.name)
                         + "&tag=" + percent_encode(name.tag),
                     "the image cannot be called '" + image + "'");
  if (const auto* why = std::get_if<edge_error>(&answer))
    return *why;
  return std::nullopt;
}

uint64_t bytes_in(const fs::path& folder) {
  uint64_t result = 0;
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error))
    result += i->file_size(error);
  return result;
}

} // namespace

std::optional<edge_error> load_image_of(const engine_door& door,
                                        const image_loading& what) {
  const auto files = check_image_folder(what.folder, what.id);
  if (const auto* why = std::get_if<edge_error>(&files))
    return *why;
  if (auto why = room_problem(what.work_dir, bytes_in(what.folder)))
    return why;
  const auto archive = what.work_dir / "loaded.tar";
  std::vector<std::string> arguments{"--create",        "--file",
                                     archive.string(),  "--format=gnu",
                                     "--owner=0",       "--group=0",
                                     "--numeric-owner", "--mtime=@0",
                                     "--directory",     what.folder.string()};
  const auto& names = std::get<std::vector<std::string>>(files);
  arguments.insert(arguments.end(), names.begin(), names.end());
  if (auto why = run_tar(std::move(arguments)))
    return disk_failure(archive, why->message);
  std::string said;
  if (auto why = upload_image(door, archive, said))
    return why;
  if (auto why = check_loaded(door, what.id, said))
    return why;
  return name_image(door, what.id, what.image);
}

} // namespace roscell
