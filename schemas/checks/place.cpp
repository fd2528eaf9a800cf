#include "schemas/checks/place.hpp"

#include "schemas/text_excerpt.hpp"

#include <set>

namespace roscell::checks {

void refuse(error_list& errors, const place& x, const std::string& expected) {
  errors.push_back({x.at.to_string(), x.value.is_null()
                                          ? absence_text(x.at.back(), expected)
                                          : "expected " + expected + ", got "
                                                + shown_value(x.value)});
}

void append(error_list& errors, const error_list& others) {
  errors.insert(errors.end(), others.begin(), others.end());
}

void check_unique(error_list& errors, const place& list, const char* member,
                  const std::string& what) {
  std::set<json> seen;
  for (const auto& item : list.items()) {
    auto id = item / member;
    if (!id.value.is_null() && !seen.insert(id.value).second)
      refuse(errors, id, what);
  }
}

bool climbs(const std::string& path) {
  return ("/" + path + "/").find("/../") != std::string::npos;
}

void check_absolute(error_list& errors, const place& x,
                    const std::string& what) {
  auto path = x.text();
  if (!path.empty() && (path.front() != '/' || climbs(path)))
    refuse(errors, x, what + " to be an absolute path without '..'");
}

void check_devices(error_list& errors, const place& list) {
  for (const auto& device : list.items())
    check_absolute(errors, device, "the device");
}

} // namespace roscell::checks
