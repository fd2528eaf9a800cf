#include "actors/placement/reading/short_forms.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "messages/stream_protocols.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

using word_list = std::vector<std::string>;

/// What cameras and films give.
constexpr const char* picture_type = "sensor_msgs/msg/Image";

bool has(const word_list& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string listed(const word_list& words) {
  std::string result;
  for (const auto& word : words)
    result += (result.empty() ? "" : ", ") + in_quotes(word);
  return result;
}

int64_t last_added(const skill_row& row) {
  const auto& xs = row.added_unix_ms;
  return xs.empty() ? 0 : *std::max_element(xs.begin(), xs.end());
}

/// The newest build that has the step's operation and model; null if none.
const skill_descriptor* descriptor_of(const task_step& step,
                                      const skill_list& skills) {
  const skill_row* best = nullptr;
  for (const auto& row : skills.skills) {
    const auto& models = row.skill.descriptor.models;
    const bool fits =
        row.skill.descriptor.operation == step.operation
        && row.skill.hash.compare(0, step.build.size(), step.build) == 0
        && std::any_of(models.begin(), models.end(),
                       [&](const auto& x) { return x.name == step.model; });
    if (fits && (best == nullptr || last_added(row) > last_added(*best)))
      best = &row;
  }
  return best == nullptr ? nullptr : &best->skill.descriptor;
}

/// The types of a port that a protocol can carry.
word_list types_for(const port_description& port, const std::string& protocol) {
  word_list result;
  for (const auto& type : port.data_types)
    if (is_message_type(type) == (protocol != protocols::file))
      result.push_back(type);
  return result;
}

std::string protocol_by_form(const std::string& endpoint,
                             const word_list& known) {
  if (known.size() == 1)
    return known.front();
  if (looks_like_video(endpoint) && has(known, protocols::video))
    return std::string{protocols::video};
  const auto guess =
      looks_like_file(endpoint) ? protocols::file : protocols::ros2;
  return has(known, guess) ? std::string{guess} : "";
}

class writer {
public:
  writer(std::string task, const std::vector<task_step>& pipeline,
         const skill_list& skills, std::string pointer)
      : task_(std::move(task)), pointer_(std::move(pointer)) {
    for (size_t i = 0; i < pipeline.size(); ++i) {
      const auto at = pointer_ + "/" + std::to_string(i);
      result_.steps.push_back({pipeline[i],
                               places(at + "/input", pipeline[i].input),
                               places(at + "/output", pipeline[i].output)});
      skills_.push_back(descriptor_of(pipeline[i], skills));
    }
  }

  written_pipeline run() {
    for (size_t i = 0; i < size(); ++i)
      complete_outputs(i);
    for (size_t i = 0; i < size(); ++i)
      complete_inputs(i);
    return std::move(result_);
  }

private:
  static word_list places(const std::string& at,
                          const std::vector<io_endpoint>& ends) {
    word_list result;
    for (size_t i = 0; i < ends.size(); ++i)
      result.push_back(ends.size() == 1 ? at : at + "/" + std::to_string(i));
    return result;
  }

  size_t size() const {
    return result_.steps.size();
  }

  task_step& step(size_t i) {
    return result_.steps[i].step;
  }

  void refuse(const std::string& at, std::string text) {
    result_.errors.push_back({at, std::move(text)});
  }

  // -- ends that say where they are -----------------------------------------

  void complete_outputs(size_t i) {
    auto& ends = step(i).output;
    for (size_t k = 0; k < ends.size(); ++k) {
      const auto& at = result_.steps[i].output_at[k];
      if (!ends[k].from.empty())
        refuse(at + "/from", "an output comes from its own step; \"from\" is "
                             "for inputs");
      else if (skills_[i] != nullptr)
        complete(ends[k], skills_[i]->output, at);
    }
  }

  void complete(io_endpoint& end, const port_description& port,
                const std::string& at) {
    if (end.endpoint.empty())
      return refuse(at, "expected an endpoint, or \"from\" and a step that "
                        "writes it");
    if (end.protocol.empty())
      end.protocol = protocol_by_form(end.endpoint, port.protocols);
    if (end.protocol.empty())
      return refuse(at, "expected a protocol for " + in_quotes(end.endpoint)
                            + ", one of " + listed(port.protocols));
    if (end.protocol == protocols::file && end.endpoint.front() != '/')
      return refuse(at, "expected the endpoint of a file to be an absolute "
                        "path, got "
                            + in_quotes(end.endpoint));
    if (end.data_type.empty())
      end.data_type = guess_type(end, types_for(port, end.protocol));
    if (end.data_type.empty())
      refuse(at, "expected a data type for " + in_quotes(end.endpoint)
                     + ", one of " + listed(types_for(port, end.protocol)));
  }

  std::string guess_type(const io_endpoint& end, const word_list& known) {
    if (known.size() == 1)
      return known.front();
    if (end.protocol == protocols::file) {
      auto type = type_of_file(end.endpoint);
      return has(known, type) ? type : "";
    }
    if (end.protocol == protocols::video)
      return has(known, picture_type) ? picture_type : "";
    if (auto type = type_written(end); has(known, type))
      return type;
    const auto name = endpoint_name(end.endpoint);
    const auto named =
        std::find_if(known.begin(), known.end(),
                     [&](const auto& type) { return type_name(type) == name; });
    return named == known.end() ? "" : *named;
  }

  /// What a step of the task writes to a topic; empty if none does.
  std::string type_written(const io_endpoint& read) {
    for (const auto& x : result_.steps)
      for (const auto& end : x.step.output)
        if (end.protocol == read.protocol
            && full_topic(end.endpoint) == full_topic(read.endpoint))
          return end.data_type;
    return {};
  }

  // -- inputs that name another step ----------------------------------------

  void complete_inputs(size_t i) {
    auto ends = std::exchange(step(i).input, {});
    auto places = std::exchange(result_.steps[i].input_at, {});
    for (size_t k = 0; k < ends.size(); ++k) {
      if (!ends[k].from.empty()) {
        join(i, ends[k], places[k]);
        continue;
      }
      if (skills_[i] != nullptr)
        complete(ends[k], skills_[i]->input, places[k]);
      add_input(i, ends[k], places[k]);
    }
  }

  void add_input(size_t i, const io_endpoint& end, const std::string& at) {
    step(i).input.push_back(end);
    result_.steps[i].input_at.push_back(at);
  }

  void join(size_t reader, const io_endpoint& request, const std::string& at) {
    if (!request.endpoint.empty() || !request.protocol.empty())
      return refuse(at, "expected either \"from\" or an endpoint, got both");
    auto [from, output] = split(request.from);
    if (from == size())
      return refuse(at + "/from", unknown_step(request.from));
    if (from == reader)
      return refuse(at + "/from", "a step cannot read what it writes");
    if (skills_[from] == nullptr || skills_[reader] == nullptr)
      return add_input(reader, request, at);
    auto found = outputs_for(from, reader, output);
    if (found.empty())
      return refuse(at + "/from", no_output(from, reader, output));
    add_outputs(from, found);
    for (auto& end : found) {
      end.external = request.external;
      add_input(reader, end, at);
    }
  }

  /// A step's position and the name of its output. An id may have dots.
  std::pair<size_t, std::string> split(const std::string& text) {
    if (const auto i = position(text); i < size())
      return {i, ""};
    const auto dot = text.rfind('.');
    if (dot == std::string::npos)
      return {size(), ""};
    return {position(text.substr(0, dot)), text.substr(dot + 1)};
  }

  size_t position(const std::string& id) {
    size_t i = 0;
    while (i < size() && step(i).id != id)
      ++i;
    return i;
  }

  std::string unknown_step(const std::string& text) {
    std::vector<std::string_view> ids;
    for (const auto& x : result_.steps)
      ids.emplace_back(x.step.id);
    const auto typed = text.substr(0, text.rfind('.'));
    const auto meant = closest_word(typed, ids);
    return "there is no step " + in_quotes(typed)
           + (meant.empty() ? "" : "; did you mean " + in_quotes(meant) + "?");
  }

  bool takes(size_t reader, const io_endpoint& end) const {
    const auto& port = skills_[reader]->input;
    return has(port.protocols, end.protocol)
           && has(port.data_types, end.data_type);
  }

  /// Outputs that the step names go before those that it could have.
  std::vector<io_endpoint> outputs_for(size_t from, size_t reader,
                                       const std::string& output) {
    std::vector<io_endpoint> result;
    for (const auto& end : step(from).output) {
      const bool wanted = output.empty()
                              ? takes(reader, end)
                              : output == endpoint_name(end.endpoint)
                                    || output == type_name(end.data_type);
      if (wanted)
        result.push_back(end);
    }
    if (result.empty())
      result = outputs_it_could_have(from, reader, output);
    if (output.empty())
      drop_compressed_forms(result);
    return result;
  }

  std::vector<io_endpoint> outputs_it_could_have(size_t from, size_t reader,
                                                 const std::string& output) {
    std::vector<io_endpoint> result;
    for (const auto& type : skills_[from]->output.data_types) {
      const auto end = made_up(from, type);
      const bool wanted = output.empty() || output == type_name(type);
      if (wanted && takes(reader, end)
          && has(skills_[from]->output.protocols, end.protocol))
        result.push_back(end);
    }
    return result;
  }

  /// Who names no output gets one form of what a step gives, and not
  /// CompressedImage beside Image.
  static void drop_compressed_forms(std::vector<io_endpoint>& ends) {
    const auto all = ends;
    const auto is_second = [&](const io_endpoint& end) {
      return std::any_of(all.begin(), all.end(), [&](const auto& plain) {
        return type_name(end.data_type)
               == "compressed_" + type_name(plain.data_type);
      });
    };
    ends.erase(std::remove_if(ends.begin(), ends.end(), is_second), ends.end());
  }

  /// Lets a step write what it would not without a reader.
  void add_outputs(size_t from, const std::vector<io_endpoint>& ends) {
    for (const auto& end : ends) {
      auto& written = step(from).output;
      if (std::find(written.begin(), written.end(), end) != written.end())
        continue;
      written.push_back(end);
      result_.steps[from].output_at.push_back(
          pointer_ + "/" + std::to_string(from) + "/output");
    }
  }

  io_endpoint made_up(size_t from, const std::string& type) {
    return {std::string{protocols::ros2},
            "/" + topic_word(task_) + "/" + topic_word(step(from).id) + "/"
                + type_name(type),
            type, "", false};
  }

  std::string no_output(size_t from, size_t reader, const std::string& output) {
    word_list names;
    for (const auto& end : step(from).output)
      names.push_back(endpoint_name(end.endpoint));
    for (const auto& type : skills_[from]->output.data_types)
      if (!has(names, type_name(type)))
        names.push_back(type_name(type));
    if (output.empty())
      return "step " + in_quotes(step(reader).id) + " takes none of what step "
             + in_quotes(step(from).id) + " gives: it takes "
             + listed(skills_[reader]->input.data_types) + " by "
             + listed(skills_[reader]->input.protocols) + ", that one gives "
             + listed(skills_[from]->output.data_types) + " by "
             + listed(skills_[from]->output.protocols);
    return "step " + in_quotes(step(from).id) + " has no output "
           + in_quotes(output) + " that step " + in_quotes(step(reader).id)
           + " takes; it has " + listed(names);
  }

  const std::string task_;
  const std::string pointer_;
  written_pipeline result_;
  std::vector<const skill_descriptor*> skills_; ///< Null: nobody has it.
};

} // namespace

written_step as_written(const task_step& step) {
  return {step, word_list(step.input.size()), word_list(step.output.size())};
}

written_pipeline write_out(const std::string& task,
                           const std::vector<task_step>& pipeline,
                           const skill_list& skills,
                           const std::string& pointer) {
  return writer{task, pipeline, skills, pointer}.run();
}

} // namespace roscell
