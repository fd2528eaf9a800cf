#pragma once

#include <cstdint>

/// Parameter ids of RTPS 2.3, 9.6.2.2.2, DDS-XTypes 1.2, DDS Security 1.1 and
/// Fast DDS that we write or look at.
namespace roscell::parameter_id {

enum value : std::uint16_t {
  padding = 0x0000,
  sentinel = 0x0001,
  lease_duration = 0x0002,
  topic_name = 0x0005,
  type_name = 0x0007,
  protocol_version = 0x0015,
  vendor_id = 0x0016,
  partition = 0x0029,
  user_data = 0x002c,
  group_data = 0x002d,
  topic_data = 0x002e,
  metatraffic_unicast_locator = 0x0032,
  content_filter = 0x0035,
  participant_guid = 0x0050,
  builtin_endpoint_set = 0x0058,
  property_list = 0x0059,
  endpoint_guid = 0x005a,
  entity_name = 0x0062,
  type_id = 0x0069,
  key_hash = 0x0070,
  status_info = 0x0071,
  type_object = 0x0072,
  data_representation = 0x0073,
  type_information = 0x0075,
  related_sample_identity = 0x800f,
  identity_token = 0x1001,
  permissions_token = 0x1002,
  data_tags = 0x1003,
  identity_status_token = 0x1006,
  data_sharing = 0x8006,
};

} // namespace roscell::parameter_id
