#include "actors/requests/history/decision_length.hpp"

#include "messages/codec/json_codec.hpp"

namespace roscell {

namespace {

/// How many of the first of these have room.
size_t fitting(const json& list, size_t most_bytes) {
  size_t bytes = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    bytes += list[i].dump().size() + 1;
    if (bytes > most_bytes)
      return i;
  }
  return list.size();
}

} // namespace

void shorten_decision(std::string& text, size_t most_bytes) {
  if (text.size() <= most_bytes)
    return;
  auto document = json::parse(text, nullptr, false);
  const bool refused = document.is_object() && document.contains("error");
  auto& explained = refused ? document["error"] : document;
  if (!explained.is_object() || !explained.contains("rejected"))
    return;
  auto& rejected = explained["rejected"];
  const auto all = rejected.size();
  const auto excess = text.size() - most_bytes;
  const auto size = rejected.dump().size();
  const auto kept = fitting(rejected, size > excess ? size - excess : 0);
  rejected.erase(rejected.begin() + static_cast<json::difference_type>(kept),
                 rejected.end());
  const auto words = "of " + std::to_string(all) + " rejected candidates, "
                     + std::to_string(kept) + " are kept";
  if (refused)
    explained["message"] = explained.value("message", "") + "; " + words;
  else
    explained["warnings"].push_back(words);
  text = document.dump();
}

} // namespace roscell
