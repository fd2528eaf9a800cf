#include "skills/ros2/status_text.hpp"

namespace roscell::ros2 {

namespace dds = eprosima::fastdds::dds;

std::string matched_text(const std::string& topic, const std::string& peer,
                         int count, int change) {
  return "'" + topic + "': a " + peer + (change < 0 ? " has left" : " has come")
         + "; now " + std::to_string(count);
}

std::string incompatible_text(const std::string& topic, const std::string& peer,
                              dds::QosPolicyId_t policy) {
  auto start = "'" + topic + "': a " + peer + " is left out, because ";
  switch (policy) {
  case dds::RELIABILITY_QOS_POLICY_ID:
    return start
           + "one end wants what the other does not offer; set parameter "
             "'ros2_reliability' to 'best_effort' where it is read";
  case dds::DURABILITY_QOS_POLICY_ID:
    return start
           + "one end wants what the other does not offer; set parameter "
             "'ros2_durability' to 'volatile' where it is read";
  default:
    return start + "the two differ in QoS policy " + std::to_string(policy);
  }
}

} // namespace roscell::ros2
