#include "tools/roscell/doctor/finding.hpp"

#include <algorithm>

namespace roscell::cli {

const char* to_word(judgement how) {
  switch (how) {
  case judgement::ok:
    return "ok";
  case judgement::skipped:
    return "skipped";
  case judgement::warning:
    return "warning";
  default:
    return "broken";
  }
}

bool is_broken(const findings& all) {
  return std::any_of(all.begin(), all.end(),
                     [](auto& x) { return x.how == judgement::broken; });
}

json to_json_list(const findings& all) {
  auto result = json::array();
  for (const auto& x : all) {
    json one{{"check", x.check},
             {"area", x.area},
             {"verdict", to_word(x.how)},
             {"seen", x.seen}};
    if (!x.matters.empty())
      one["matters"] = x.matters;
    if (!x.remedy.empty())
      one["remedy"] = x.remedy;
    result.push_back(std::move(one));
  }
  return result;
}

} // namespace roscell::cli
