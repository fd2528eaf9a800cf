#pragma once

#include <fastdds/dds/core/policy/QosPolicies.hpp>

#include <string>

/// INTERNAL to this folder: what an instance's log says of its topics.
namespace roscell::ros2 {

/// "'/scene_1/image': a writer has come, there is 1 now". `change` may be
/// negative.
std::string matched_text(const std::string& topic, const std::string& peer,
                         int count, int change);

/// Which parameter makes the two ends agree.
std::string incompatible_text(const std::string& topic, const std::string& peer,
                              eprosima::fastdds::dds::QosPolicyId_t policy);

} // namespace roscell::ros2
