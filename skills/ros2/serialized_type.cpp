#include "skills/ros2/serialized_type.hpp"

#include <cstring>

namespace roscell::ros2 {

namespace {

constexpr std::uint32_t encapsulation_bytes = 4;

std::string& bytes_at(void* data) {
  return *static_cast<std::string*>(data);
}

} // namespace

serialized_type::serialized_type(const std::string& name) {
  setName(name.c_str());
  // Only where memory starts: it grows with the message. Fast DDS reserves a
  // hundred times this number for each endpoint.
  m_typeSize = encapsulation_bytes;
  m_isGetKeyDefined = false;
  // ROS 2 sends no descriptions of types either.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool serialized_type::serialize(void* data, payload* to) {
  const auto& bytes = bytes_at(data);
  if (bytes.size() < encapsulation_bytes || bytes.size() > to->max_size)
    return false;
  std::memcpy(to->data, bytes.data(), bytes.size());
  to->length = static_cast<std::uint32_t>(bytes.size());
  to->encapsulation = bytes[1] == 0 ? CDR_BE : CDR_LE;
  return true;
}

bool serialized_type::deserialize(payload* from, void* data) {
  if (from->length < encapsulation_bytes)
    return false;
  bytes_at(data).assign(reinterpret_cast<const char*>(from->data),
                        from->length);
  return true;
}

std::function<std::uint32_t()>
serialized_type::getSerializedSizeProvider(void* data) {
  return [data] { return static_cast<std::uint32_t>(bytes_at(data).size()); };
}

void* serialized_type::createData() {
  return new std::string;
}

void serialized_type::deleteData(void* data) {
  delete static_cast<std::string*>(data);
}

bool serialized_type::getKey(void*, handle*, bool) {
  return false; // Messages of ROS 2 have no keys.
}

} // namespace roscell::ros2
