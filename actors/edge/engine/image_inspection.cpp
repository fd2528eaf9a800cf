#include "actors/edge/engine/image_inspection.hpp"

#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/engine_json.hpp"
#include "actors/edge/engine/image_layers.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/limits.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <variant>

namespace roscell {

namespace {

constexpr int not_found = 404;

using document = nlohmann::json;

document parse_reply(const http_reply& reply) {
  return document::parse(reply.body, nullptr, false);
}

/// Of a list of texts; others in it are left out.
std::vector<std::string> texts_in(const document& object, const char* name) {
  std::vector<std::string> result;
  const auto i = object.find(name);
  if (i != object.end() && i->is_array())
    for (const auto& x : *i)
      if (x.is_string())
        result.push_back(x.get<std::string>());
  return result;
}

/// Podman leaves out what comes before an id's digits.
std::string whole_id(std::string id) {
  return id.empty() || is_image_id(id) ? id : "sha256:" + id;
}

edge_result<http_reply> ask_anything(const engine_door& door,
                                     const std::string& method,
                                     const std::string& path) {
  http_endpoint to;
  to.socket_path = door.socket;
  return http_client{to}.request(method, api_path(door, path), {},
                                 within(door, limits::engine::call));
}

edge_error no_sense(const std::string& what) {
  return {error_code::engine_failed,
          "the container engine says of " + what + " what makes no sense", ""};
}

} // namespace

http_client::options within(const engine_door& door,
                            std::chrono::milliseconds limit) {
  http_client::options result;
  result.timeout = limit;
  result.cancel = door.cancel.get();
  return result;
}

std::string api_path(const engine_door& door, const std::string& path) {
  return (door.api.empty() ? "" : "/v" + door.api) + path;
}

edge_result<http_reply> ask_engine_now(const engine_door& door,
                                       const std::string& method,
                                       const std::string& path,
                                       const std::string& what) {
  auto answer = ask_anything(door, method, path);
  if (const auto* reply = std::get_if<http_reply>(&answer))
    if (const engine_reply x{reply->status, reply->body}; !x.ok())
      return engine_refusal(what, x);
  return answer;
}

edge_result<std::optional<engine_image>>
inspect_image(const engine_door& door, const std::string& image) {
  const auto what = "the image '" + image + "'";
  const auto answer =
      ask_anything(door, "GET", "/images/" + image_path(image) + "/json");
  if (const auto* why = std::get_if<edge_error>(&answer))
    return *why;
  const auto& reply = std::get<http_reply>(answer);
  if (reply.status == not_found)
    return std::optional<engine_image>{};
  if (const engine_reply x{reply.status, reply.body}; !x.ok())
    return engine_refusal("cannot look for " + what, x);
  const auto about = parse_reply(reply);
  if (!about.is_object())
    return no_sense(what);
  engine_image result;
  result.id = whole_id(text_at(about, "Id"));
  result.architecture = text_at(about, "Architecture");
  const auto size = about.find("Size");
  if (size != about.end() && size->is_number_integer())
    result.bytes = std::max<int64_t>(0, size->get<int64_t>());
  const auto root = about.find("RootFS");
  if (root != about.end() && root->is_object())
    result.layers = texts_in(*root, "Layers");
  if (!is_image_id(result.id))
    return no_sense(what);
  return std::optional{std::move(result)};
}

edge_result<std::vector<std::string>> list_chains(const engine_door& door) {
  const auto answer =
      ask_engine_now(door, "GET", "/images/json", "cannot list its images");
  if (const auto* why = std::get_if<edge_error>(&answer))
    return *why;
  const auto images = parse_reply(std::get<http_reply>(answer));
  if (!images.is_array())
    return no_sense("its images");
  std::set<std::string> chains;
  size_t asked = 0;
  for (const auto& x : images) {
    if (!x.is_object() || ++asked > limits::engine::inspected_images)
      break;
    const auto image = inspect_image(door, text_at(x, "Id"));
    if (const auto* why = std::get_if<edge_error>(&image))
      return *why;
    // It may have gone meanwhile.
    if (const auto& known = std::get<std::optional<engine_image>>(image))
      for (auto& chain : chain_ids(known->layers))
        if (chains.size() < limits::engine::most_layers && is_image_id(chain))
          chains.insert(std::move(chain));
  }
  return std::vector<std::string>(chains.begin(), chains.end());
}

} // namespace roscell
