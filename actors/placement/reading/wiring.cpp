#include "actors/placement/reading/wiring.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "messages/stream_protocols.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

/// One end that somebody writes.
struct written_end {
  size_t step;      ///< Position; unused where another task writes it.
  std::string text; ///< Who writes it where.
  io_endpoint end;
  bool elsewhere; ///< Another task does.
};

bool is_topic_end(const io_endpoint& x) {
  return x.protocol == protocols::ros2;
}

bool is_file_end(const io_endpoint& x) {
  return x.protocol == protocols::file;
}

/// Frames that steps pass on within one process.
bool is_actor_end(const io_endpoint& x) {
  return x.protocol == protocols::actor;
}

/// Many nodes publish transforms under one name.
bool is_shared(const io_endpoint& x) {
  return x.data_type == "tf2_msgs/msg/TFMessage";
}

/// Pictures go into a folder, each under a name of its own.
bool is_folder(const io_endpoint& x) {
  return x.endpoint.back() == '/' || x.data_type.rfind("image/", 0) == 0;
}

bool same_topic(const io_endpoint& x, const io_endpoint& y) {
  return is_topic_end(x) && is_topic_end(y)
         && full_topic(x.endpoint) == full_topic(y.endpoint);
}

/// A label that two steps want with different values, as `host=a and host=b`;
/// empty if no node's labels keep them apart.
std::string contradiction(const task_step& x, const task_step& y) {
  for (const auto& [name, value] : x.labels)
    if (const auto other = y.labels.find(name);
        other != y.labels.end() && other->second != value)
      return name + "=" + value + " and " + name + "=" + other->second;
  return {};
}

class wirer {
public:
  wirer(const std::string& task, const std::vector<written_step>& steps,
        const std::vector<deployed_end>& cell,
        const std::optional<std::vector<io_endpoint>>& topics)
      : steps_(steps), topics_(topics) {
    for (size_t i = 0; i < steps.size(); ++i)
      for (size_t k = 0; k < steps[i].step.output.size(); ++k)
        written_.push_back({i,
                            "step " + in_quotes(steps[i].step.id) + " (at "
                                + steps[i].output_at[k] + ")",
                            steps[i].step.output[k], false});
    for (const auto& x : cell)
      if (x.task != task)
        written_.push_back({0,
                            "step " + in_quotes(x.step) + " of task "
                                + in_quotes(x.task) + " on '" + x.node + "'",
                            x.end, true});
    root_.resize(steps.size());
    std::iota(root_.begin(), root_.end(), size_t{0});
  }

  wiring run() {
    for (size_t i = 0; i < steps_.size(); ++i) {
      for (size_t k = 0; k < steps_[i].step.input.size(); ++k)
        check_input(i, k);
      for (size_t k = 0; k < steps_[i].step.output.size(); ++k)
        check_output(i, k);
    }
    number_groups();
    return std::move(result_);
  }

private:
  void refuse(const std::string& at, std::string text) {
    result_.errors.push_back({at, std::move(text)});
  }

  void warn(const std::string& at, const std::string& text) {
    result_.warnings.push_back("at " + at + ": " + text);
  }

  // -- what is read ---------------------------------------------------------

  void check_input(size_t i, size_t k) {
    const auto& end = steps_[i].step.input[k];
    const auto& at = steps_[i].input_at[k];
    if (is_topic_end(end))
      check_topic(end, at, end.external || steps_[i].step.external);
    else if (is_file_end(end))
      join_by_file(i, end, at);
    else if (is_actor_end(end))
      join_by_actor(i, end, at);
  }

  void check_topic(const io_endpoint& end, const std::string& at,
                   bool external) {
    const written_end* other_type = nullptr;
    for (const auto& x : written_) {
      if (!same_topic(x.end, end))
        continue;
      if (x.end.data_type == end.data_type)
        return external ? warn(at, "the topic is external, but " + x.text
                                       + " writes it")
                        : void();
      other_type = &x;
    }
    if (external)
      return check_external(end, at);
    if (other_type != nullptr)
      refuse(at, other_type->text + " writes the topic "
                     + in_quotes(end.endpoint) + " as "
                     + in_quotes(other_type->end.data_type) + ", it is read as "
                     + in_quotes(end.data_type));
    else
      refuse(at, nobody_writes(end));
  }

  void check_external(const io_endpoint& end, const std::string& at) {
    if (!topics_)
      return;
    for (const auto& x : *topics_) {
      if (!same_topic(x, end))
        continue;
      if (x.data_type != end.data_type)
        warn(at, "the external topic " + in_quotes(end.endpoint, 80)
                     + " is written as " + in_quotes(x.data_type)
                     + ", it is read as " + in_quotes(end.data_type));
      return;
    }
    warn(at, "nobody writes the external topic " + in_quotes(end.endpoint, 80)
                 + " yet");
  }

  std::string nobody_writes(const io_endpoint& end) const {
    std::vector<std::string_view> topics;
    for (const auto& x : written_)
      if (is_topic_end(x.end))
        topics.emplace_back(x.end.endpoint);
    auto text =
        "nobody in this cell writes the topic " + in_quotes(end.endpoint, 80);
    const auto meant = closest_word(end.endpoint, topics);
    for (const auto& x : written_)
      if (!meant.empty() && x.end.endpoint == meant)
        return text + "; did you mean " + in_quotes(meant, 80) + " of " + x.text
               + "?";
    return text
           + "; say \"external\": true if a program that ROSCell does not "
             "start writes it";
  }

  void join_by_file(size_t i, const io_endpoint& end, const std::string& at) {
    for (const auto& x : written_) {
      if (x.elsewhere || x.step == i || !is_file_end(x.end)
          || !overlap(x.end.endpoint, end.endpoint))
        continue;
      join(i, x, "the file " + in_quotes(end.endpoint, 80), at);
    }
  }

  void join_by_actor(size_t i, const io_endpoint& end, const std::string& at) {
    const auto stream = "the stream " + in_quotes(end.endpoint, 80);
    bool written = false;
    for (const auto& x : written_) {
      if (x.elsewhere || !is_actor_end(x.end) || x.end.endpoint != end.endpoint)
        continue;
      written = true;
      join(i, x, stream, at);
    }
    if (!written)
      refuse(at, "no step of this task writes " + stream
                     + "; one of another task or process is reached by a "
                       "topic");
  }

  void join(size_t i, const written_end& x, const std::string& by,
            const std::string& at) {
    const auto apart = contradiction(steps_[i].step, steps_[x.step].step);
    if (apart.empty())
      unite(i, x.step);
    else
      refuse(at, by + " is written by " + x.text
                     + ", and both must run on one node, but they want " + apart
                     + "; join them by a topic");
  }

  // -- what is written ------------------------------------------------------

  /// Against what is written before it, so that each pair is looked at once.
  void check_output(size_t i, size_t k) {
    const auto& end = steps_[i].step.output[k];
    const auto& at = steps_[i].output_at[k];
    bool reached = false;
    for (const auto& x : written_) {
      reached = reached || &x.end == own(i, k);
      if (!x.elsewhere && reached)
        continue;
      if (same_topic(x.end, end))
        check_second_writer(end, at, x);
      else if (is_file_end(x.end) && is_file_end(end)
               && x.end.endpoint == end.endpoint)
        check_second_file(i, end, at, x);
    }
  }

  /// The entry of an output of the task.
  const io_endpoint* own(size_t i, size_t k) const {
    size_t position = k;
    for (size_t before = 0; before < i; ++before)
      position += steps_[before].step.output.size();
    return &written_[position].end;
  }

  void check_second_writer(const io_endpoint& end, const std::string& at,
                           const written_end& first) {
    const auto both = "the topic " + in_quotes(end.endpoint, 80)
                      + " is written by " + first.text + ", too";
    if (first.end.data_type != end.data_type)
      refuse(at, both + ", as " + in_quotes(first.end.data_type));
    else if (!is_shared(end))
      warn(at, both);
  }

  void check_second_file(size_t i, const io_endpoint& end,
                         const std::string& at, const written_end& first) {
    const auto both = "the file " + in_quotes(end.endpoint, 80)
                      + " is written by " + first.text + ", too";
    if (first.elsewhere || is_folder(end))
      warn(at, both + "; what has one name there is overwritten");
    else if (contradiction(steps_[i].step, steps_[first.step].step).empty())
      refuse(at, both);
  }

  // -- what must share a node -----------------------------------------------

  size_t root(size_t i) {
    while (root_[i] != i)
      i = root_[i];
    return i;
  }

  void unite(size_t x, size_t y) {
    const auto low = std::min(root(x), root(y));
    root_[std::max(root(x), root(y))] = low;
  }

  void number_groups() {
    std::vector<size_t> members(steps_.size());
    for (size_t i = 0; i < steps_.size(); ++i)
      ++members[root(i)];
    for (size_t i = 0; i < steps_.size(); ++i)
      result_.together.push_back(members[root(i)] > 1 ? root(i) + 1 : 0);
  }

  const std::vector<written_step>& steps_;
  const std::optional<std::vector<io_endpoint>>& topics_;
  std::vector<written_end> written_; ///< The task's own first, in order.
  std::vector<size_t> root_;         ///< Of each step, a step of its group.
  wiring result_;
};

} // namespace

wiring find_wiring(const std::string& task,
                   const std::vector<written_step>& steps,
                   const std::vector<deployed_end>& cell,
                   const std::optional<std::vector<io_endpoint>>& topics) {
  return wirer{task, steps, cell, topics}.run();
}

namespace {

using order = std::vector<std::vector<std::size_t>>;

bool reads_from(const instance_spec& reader, const instance_spec& writer) {
  for (const auto& in : reader.input)
    for (const auto& out : writer.output)
      if (in.protocol == protocols::file && out.protocol == protocols::file
          && overlap(in.endpoint, out.endpoint))
        return true;
  return false;
}

/// Whether `from` waits for `wanted`, directly or by others.
bool waits_for(const order& known, std::size_t from, std::size_t wanted) {
  std::vector<std::size_t> open{from};
  std::vector<bool> seen(known.size());
  while (!open.empty()) {
    const auto i = open.back();
    open.pop_back();
    if (i == wanted)
      return true;
    if (!seen[i])
      open.insert(open.end(), known[i].begin(), known[i].end());
    seen[i] = true;
  }
  return false;
}

} // namespace

order start_order(const std::vector<instance_spec>& specs) {
  order result(specs.size());
  // The last of the list first, so that of a circle the first ones are free.
  for (auto reader = specs.size(); reader-- > 0;)
    for (std::size_t writer = 0; writer < specs.size(); ++writer)
      if (reader != writer && reads_from(specs[reader], specs[writer])
          && !waits_for(result, writer, reader))
        result[reader].push_back(writer);
  return result;
}

} // namespace roscell
