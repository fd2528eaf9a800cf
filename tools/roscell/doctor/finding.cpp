#include "tools/roscell/doctor/finding.hpp"

#include <algorithm>

namespace roscell::cli {

const char* to_word(judgement how) {
  return enum_words(how)[static_cast<size_t>(how)].data();
}

bool is_broken(const findings& all) {
  return std::any_of(all.begin(), all.end(),
                     [](auto& x) { return x.how == judgement::broken; });
}

json to_json_list(const findings& all) {
  auto result = json::array();
  for (const auto& x : all)
    result.push_back(x);
  return result;
}

} // namespace roscell::cli
