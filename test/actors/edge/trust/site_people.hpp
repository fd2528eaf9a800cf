#pragma once

#include "actors/edge/trust/site_identity.hpp"
#include "test/actors/edge/trust/site_fixture.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

namespace roscell::test {

inline int64_t clock_unix_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// A site whose certificates are good now.
struct site_of_today {
  explicit site_of_today(const std::string& called = "hall")
      : name(called), key(private_key::make()),
        mine(make_site(called, key, clock_unix_s())) {
    // nop
  }

  own_identity issue(site_role role, const std::string& who,
                     const std::string& uuid) const {
    const auto made = private_key::make();
    return {made,
            {make_certificate({name, role, who, uuid}, made.get(), {key, mine},
                              clock_unix_s(), good_for_of(role))},
            mine};
  }

  std::shared_ptr<site_identity>
  person(site_role role, const std::string& who = "anna",
         const std::string& uuid = "0a1b",
         const std::filesystem::path& revoked = {}) const {
    return std::make_shared<site_identity>(issue(role, who, uuid), revoked);
  }

  std::string name;
  private_key key;
  certificate mine;
};

} // namespace roscell::test
