#include "dds/participant_ids.hpp"

#include <fastrtps/utils/IPLocator.h>

#include <random>

namespace roscell {

std::int32_t make_participant_id() {
  constexpr std::int32_t lowest = 1000;
  constexpr std::int32_t highest = 25000;
  std::random_device source;
  return std::uniform_int_distribution<std::int32_t>{lowest, highest}(source);
}

eprosima::fastrtps::rtps::Locator_t udp_locator(const std::string& address,
                                                std::uint32_t port) {
  eprosima::fastrtps::rtps::Locator_t result;
  eprosima::fastrtps::rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4,
                                                     address, port, result);
  return result;
}

} // namespace roscell
