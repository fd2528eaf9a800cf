#include "skills/ros2/messages/cdr.hpp"

#include "skills/ros2/messages/cdr_reader.hpp"
#include "skills/ros2/messages/cdr_writer.hpp"

namespace roscell::ros2 {

template <class T>
std::string serialize(const T& message) {
  cdr_writer out;
  out.write(message);
  return std::string{out.bytes()};
}

template <class T>
T deserialize(std::string_view payload) {
  cdr_reader in{payload};
  T result;
  in.read(result);
  in.finish();
  return result;
}

std::optional<time> stamp_of(std::string_view payload) {
  try {
    time result;
    cdr_reader{payload}.read(result);
    return result;
  } catch (const cdr_error&) {
    return std::nullopt;
  }
}

template <>
std::string serialize(const image& x) {
  return serialize(image_view{x.header, x.height, x.width, x.encoding,
                              x.is_bigendian, x.step, x.data.data(),
                              x.data.size()});
}

template <>
image deserialize(std::string_view payload) {
  auto x = view_image(payload);
  return {x.header,
          x.height,
          x.width,
          x.encoding,
          x.is_bigendian,
          x.step,
          {x.data, x.data + x.size}};
}

#define ROSCELL_CODEC(Message)                                                 \
  template std::string serialize(const Message&);                              \
  template Message deserialize(std::string_view)

ROSCELL_CODEC(header);
ROSCELL_CODEC(string);
ROSCELL_CODEC(camera_info);
ROSCELL_CODEC(pose_stamped);
ROSCELL_CODEC(tf_message);
ROSCELL_CODEC(april_tag_detection_array);
ROSCELL_CODEC(participant_entities_info<16>);
ROSCELL_CODEC(participant_entities_info<24>);

#undef ROSCELL_CODEC

} // namespace roscell::ros2
