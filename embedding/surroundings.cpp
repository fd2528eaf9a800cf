#include "embedding/surroundings.hpp"

#include "roscell/node.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace roscell::embedding {

namespace {

/// What Fast DDS 2.9 reads in the working directory.
constexpr const char* profiles_file = "DEFAULT_FASTRTPS_PROFILES.xml";

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

bool reads_profiles_file() {
  const char* skip = std::getenv("SKIP_DEFAULT_XML");
  return skip == nullptr || std::string{skip} != "1";
}

} // namespace

void check_surroundings() {
  for (const char* name : {"ROS_DISCOVERY_SERVER", "FASTDDS_ENVIRONMENT_FILE",
                           "FASTRTPS_DEFAULT_PROFILES_FILE"})
    if (is_set(name))
      throw node_error{
          "conflict",
          std::string{name} + " is set in this process and would mislead DDS",
          std::string{"unset "} + name + " before this program starts"};
  std::error_code ignored;
  if (reads_profiles_file() && std::filesystem::exists(profiles_file, ignored))
    throw node_error{"conflict",
                     std::string{profiles_file}
                         + " in the working directory would mislead DDS",
                     "set SKIP_DEFAULT_XML=1 before this program starts, or "
                     "start it elsewhere"};
}

} // namespace roscell::embedding
