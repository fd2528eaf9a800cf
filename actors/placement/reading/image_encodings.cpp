#include "actors/placement/reading/image_encodings.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "messages/stream_protocols.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>

namespace roscell {

namespace {

bool carries_images(const io_endpoint& x) {
  return x.protocol == protocols::ros2
         && x.data_type == "sensor_msgs/msg/Image";
}

/// None: any.
const json* member_of(const valued_step& x, const char* name, bool is_list) {
  const auto found = x.values.find(name);
  const auto is_there =
      found != x.values.end()
      && (is_list ? found->is_array() && !found->empty() : found->is_string());
  return is_there ? &*found : nullptr;
}

/// The first few, because there may be many.
std::string names_of(const json& list) {
  constexpr size_t shown = 8;
  std::string result;
  for (size_t i = 0; i < std::min(shown, list.size()); ++i)
    result +=
        (i == 0 ? "" : ", ")
        + (list[i].is_string() ? list[i].get<std::string>() : list[i].dump());
  return list.size() > shown ? result + ", ..." : result;
}

void compare(const valued_step& reader, const valued_step& writer,
             std::vector<schema_error>& errors) {
  const auto* taken = member_of(reader, "encodings", true);
  const auto* sent = member_of(writer, "encoding", false);
  if (taken == nullptr || sent == nullptr
      || std::find(taken->begin(), taken->end(), *sent) != taken->end())
    return;
  const auto& inputs = reader.written.step.input;
  const auto& outputs = writer.written.step.output;
  for (size_t i = 0; i < inputs.size(); ++i)
    for (size_t k = 0; k < outputs.size(); ++k)
      if (carries_images(inputs[i]) && carries_images(outputs[k])
          && full_topic(inputs[i].endpoint) == full_topic(outputs[k].endpoint))
        errors.push_back(
            {reader.written.input_at[i],
             "step " + in_quotes(writer.written.step.id) + " (at "
                 + writer.written.output_at[k] + ") sends images in encoding "
                 + in_quotes(sent->get<std::string>()) + ", but step "
                 + in_quotes(reader.written.step.id) + " takes only "
                 + names_of(*taken)
                 + "; change one of them, or put a step of the skill convert "
                   "between them"});
}

} // namespace

std::vector<schema_error>
encoding_errors(const std::vector<valued_step>& steps) {
  std::vector<schema_error> result;
  for (const auto& reader : steps)
    for (const auto& writer : steps)
      compare(reader, writer, result);
  return result;
}

} // namespace roscell
