#pragma once

#include <string>

/// Names of streams: pure text.
namespace roscell {

/// A topic as all of the cell see it: `scan` is `/scan`.
std::string full_topic(const std::string& name);

/// Whether a text can be a topic: `/` and words of letters, digits and `_`.
bool is_topic(const std::string& text);

/// Any text as a word of a topic: what may not stand there becomes `_`.
std::string topic_word(const std::string& text);

/// A short name for a data type: `camera_info` of `sensor_msgs/msg/CameraInfo`,
/// `tf` of `tf2_msgs/msg/TFMessage`, `png` of `image/png`.
std::string type_name(const std::string& data_type);

/// Whether a type is that of ROS 2 messages, as topics carry them.
bool is_message_type(const std::string& data_type);

/// The last word of an endpoint, without a file's ending: `image` of
/// `/scene_1/image`, `poses` of `/tmp/poses.jsonl`.
std::string endpoint_name(const std::string& endpoint);

/// The data type that a file's ending tells; empty if none.
std::string type_of_file(const std::string& path);

/// Whether a path is a device that not every host has, such as a camera.
bool is_device(const std::string& endpoint);

/// Whether an endpoint looks like a file rather than like a topic.
bool looks_like_file(const std::string& endpoint);

/// Whether an endpoint can only be a camera or a film.
bool looks_like_video(const std::string& endpoint);

/// Whether two paths of files are one, or one of them is in the other.
bool overlap(const std::string& path, const std::string& other);

} // namespace roscell
