#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>

#include <string>

namespace roscell::ros2 {

/// Any message, already serialized: the data object of this type is a
/// std::string that holds the message as CDR with its encapsulation. INTERNAL
/// to this folder.
class serialized_type : public eprosima::fastdds::dds::TopicDataType {
public:
  /// `name` as from dds_type_name().
  explicit serialized_type(const std::string& name);

private:
  using payload = eprosima::fastrtps::rtps::SerializedPayload_t;
  using handle = eprosima::fastrtps::rtps::InstanceHandle_t;

  bool serialize(void* data, payload* to) override;
  bool deserialize(payload* from, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, handle* key, bool force_md5) override;
};

} // namespace roscell::ros2
