#include "dds/server_ids.hpp"

namespace roscell {

guid_prefix server_prefix(std::uint8_t id) {
  return {0x44, 0x53, id, 0x5f, 0x45, 0x50, 0x52, 0x4f, 0x53, 0x49, 0x4d, 0x41};
}

std::optional<std::uint8_t> server_id_of(const guid_prefix& prefix) {
  if (prefix != server_prefix(prefix[2]))
    return std::nullopt;
  return prefix[2];
}

std::string ros_discovery_server(std::uint8_t id, const std::string& address) {
  return std::string(id, ';') + address;
}

} // namespace roscell
