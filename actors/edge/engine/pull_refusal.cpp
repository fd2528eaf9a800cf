#include "actors/edge/engine/pull_refusal.hpp"

#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/limits.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace roscell {

namespace {

enum class refusal_kind { unauthorized, throttled, unknown, away, other };

struct known_words {
  refusal_kind kind;
  std::array<std::string_view, 8> words; ///< Empty ones are none.
};

/// What engines say of registries, the plainest first.
constexpr std::array<known_words, 4> known{{
    {refusal_kind::throttled,
     {"toomanyrequests", "Too Many Requests", "too many requests", " 429"}},
    {refusal_kind::unauthorized,
     {"unauthorized", "authentication required", "no basic auth credentials",
      "access denied", "denied: ", " 401", " 403"}},
    {refusal_kind::away,
     {"no such host", "connection refused", "i/o timeout", "no route to host",
      "network is unreachable", "server misbehaving", "deadline exceeded",
      "Client.Timeout"}},
    {refusal_kind::unknown,
     {"manifest unknown", "not found", "name unknown", " 404"}},
}};

refusal_kind kind_of(const std::string& said) {
  for (const auto& x : known)
    if (std::any_of(x.words.begin(), x.words.end(), [&](auto word) {
          return !word.empty() && said.find(word) != std::string::npos;
        }))
      return x.kind;
  return refusal_kind::other;
}

std::string pull_command(const std::string& engine, const std::string& image) {
  return engine + " pull " + image;
}

/// What helps wherever the image cannot be had by this node.
std::string other_way(const std::string& engine, const std::string& image) {
  return "the others of a cell get an image from any node that has it: "
         + pull_command(engine, image) + " on one of them";
}

} // namespace

edge_error pull_refusal(const std::string& engine, const std::string& image,
                        const std::string& said) {
  const auto name = parse_image_reference(image).registry;
  const auto registry = "registry '" + name + "'";
  const auto words = ": " + engine_refusal("it says", {0, said}).message;
  const auto result = [](std::string message, std::string hint) {
    return edge_error{error_code::engine_failed, std::move(message),
                      std::move(hint)};
  };
  switch (kind_of(said)) {
  case refusal_kind::unauthorized:
    return result(
        registry + " does not let this node have '" + image + "'" + words,
        "log in as the user that the node runs as: " + engine + " login " + name
            + ", or give the node a file of logins: "
              "--registry-auth FILE; then "
            + pull_command(engine, image) + " shows whether it helps");
  case refusal_kind::throttled:
    return result(registry + " was asked too often (429)" + words,
                  "wait, or log in there: " + engine + " login " + name + "; "
                      + other_way(engine, image));
  case refusal_kind::away:
    return result(registry + " cannot be reached" + words,
                  other_way(engine, image));
  case refusal_kind::unknown:
    return result(registry + " has no image '" + image + "'" + words,
                  "is base_image right? " + pull_command(engine, image)
                      + " shows the same");
  default:
    return result(registry + " does not give '" + image + "'" + words,
                  "is it a registry? " + pull_command(engine, image)
                      + " shows the same; " + other_way(engine, image));
  }
}

edge_error pull_silence(const std::string& engine, const std::string& image) {
  return {error_code::timeout,
          "registry '" + parse_image_reference(image).registry
              + "' has said nothing for "
              + std::to_string(limits::engine::pull_silence.count())
              + " s, and was asked for '" + image + "'",
          "is it a registry, and up? " + pull_command(engine, image)
              + " shows the same; " + other_way(engine, image)};
}

} // namespace roscell
