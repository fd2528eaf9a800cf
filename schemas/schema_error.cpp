#include "schemas/schema_error.hpp"

#include "messages/codec/json_codec.hpp"

#include <algorithm>

namespace roscell {

namespace {

constexpr size_t max_listed = 50;

std::string summary(const std::vector<schema_error>& errors) {
  const auto& first = errors.front();
  auto place = first.pointer.empty() ? "the document" : first.pointer;
  auto result = place + ": " + first.expected;
  if (auto others = errors.size() - 1; others > 0)
    result += " (and " + std::to_string(others)
              + (others == 1 ? " more error)" : " more errors)");
  return result;
}

} // namespace

failure to_failure(const std::vector<schema_error>& errors) {
  json list = json::array();
  const auto listed = std::min(errors.size(), max_listed);
  for (size_t i = 0; i < listed; ++i)
    list.push_back(
        {{"where", errors[i].pointer}, {"expected", errors[i].expected}});
  json details{{"errors", std::move(list)}};
  if (listed < errors.size())
    details["more"] = errors.size() - listed;
  return {error_code::schema_violation, summary(errors), errors.front().pointer,
          "correct every place that `errors` lists", details.dump()};
}

} // namespace roscell
