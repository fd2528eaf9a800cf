#include "actors/instances/instance_id.hpp"

#include <algorithm>

namespace roscell {

bool is_instance_id(const std::string& text) {
  const auto fits = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
           || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  constexpr size_t max_bytes = 200; // A file name may have 255.
  return !text.empty() && text.size() <= max_bytes && text[0] != '.'
         && std::all_of(text.begin(), text.end(), fits);
}

} // namespace roscell
