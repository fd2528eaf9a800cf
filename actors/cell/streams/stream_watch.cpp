#include "actors/cell/streams/stream_watch.hpp"

#include "messages/step_end.hpp"
#include "messages/stream_protocols.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

using row_list = std::vector<const instance_row*>;

/// Somebody writes this topic; `row` may write several.
struct written_topic {
  const instance_row* row;
  size_t output;
};

/// The writers of each topic of the cell, by its name and type: under one name
/// ROS 2 keeps those of different types apart.
using topic_key = std::pair<std::string, std::string>;
using topic_writers = std::multimap<topic_key, written_topic>;

bool is_topic(const io_endpoint& x) {
  return x.protocol == protocols::ros2;
}

topic_key key_of(const io_endpoint& x) {
  return {x.endpoint, x.data_type};
}

topic_writers writers_in(const row_list& rows) {
  topic_writers result;
  for (const auto* row : rows)
    if (row->state == instance_state::running)
      for (size_t i = 0; i < row->spec.output.size(); ++i)
        if (is_topic(row->spec.output[i]))
          result.insert({key_of(row->spec.output[i]), {row, i}});
  return result;
}

bool goes_on_sending(const written_topic& x) {
  const auto* count = output_count(*x.row, x.output);
  return count != nullptr && count->steady_s >= stream_watch::long_enough_s;
}

std::string name_of(const instance_row& writer, const instance_row& reader) {
  return "step '" + writer.spec.step
         + (writer.spec.task == reader.spec.task
                ? "'"
                : "' of task '" + writer.spec.task + "'");
}

std::string sentence_on(const instance_row& reader, const io_endpoint& input,
                        const stream_count& count, const instance_row& writer) {
  return "input '" + input.endpoint + "' has had no frame "
         + (count.frames == 0 ? "at all"
                              : "for "
                                    + std::to_string(static_cast<int64_t>(
                                        std::floor(count.quiet_s)))
                                    + " s")
         + ", though " + name_of(writer, reader) + " on node '" + writer.node
         + "' goes on sending; `roscell topics` and `roscell doctor` look for "
           "the cause";
}

/// What is to be said of one instance.
struct stream_verdict {
  std::string reason;  ///< Empty: it gets what is sent, as far as is known.
  bool certain = true; ///< All that counts has just been told.
};

stream_verdict verdict_on(const instance_row& row, const topic_writers& writers,
                          const std::set<std::string>& reported) {
  if (reported.count(row.node) == 0)
    return {{}, false};
  stream_verdict result;
  for (size_t i = 0; i < row.spec.input.size(); ++i) {
    const auto& input = row.spec.input[i];
    const auto* count = input_count(row, i);
    if (!is_topic(input) || count == nullptr
        || count->quiet_s < stream_watch::long_enough_s)
      continue;
    const auto [first, last] = writers.equal_range(key_of(input));
    for (auto x = first; x != last; ++x) {
      const auto& writer = *x->second.row;
      if (&writer == &row)
        continue;
      if (reported.count(writer.node) == 0)
        result.certain = false;
      else if (goes_on_sending(x->second))
        return {sentence_on(row, input, *count, writer), true};
    }
  }
  return result;
}

} // namespace

std::vector<std::string>
stream_watch::judge(const row_list& rows,
                    const std::set<std::string>& reported) {
  const auto before = std::exchange(reasons_, {});
  const auto writers = writers_in(rows);
  std::vector<std::string> result;
  for (const auto* row : rows) {
    if (row->state != instance_state::running)
      continue;
    const auto& id = row->spec.instance;
    const auto known = before.find(id);
    const bool was_starved = known != before.end();
    auto verdict = verdict_on(*row, writers, reported);
    if (!verdict.certain && was_starved)
      verdict.reason = known->second;
    if (verdict.reason.empty() == was_starved)
      result.push_back(id);
    if (!verdict.reason.empty())
      reasons_[id] = std::move(verdict.reason);
  }
  return result;
}

std::set<std::string> nodes_around(const row_list& all, const row_list& some) {
  std::set<std::string> result;
  std::set<topic_key> read;
  for (const auto* row : some)
    if (is_live(row->state)) {
      result.insert(row->node);
      for (const auto& input : row->spec.input)
        if (is_topic(input))
          read.insert(key_of(input));
    }
  for (const auto& [topic, writer] : writers_in(all))
    if (read.count(topic) > 0)
      result.insert(writer.row->node);
  return result;
}

const std::string* stream_watch::reason_of(const std::string& instance) const {
  const auto known = reasons_.find(instance);
  return known == reasons_.end() ? nullptr : &known->second;
}

namespace {

/// More of them would drown the first.
constexpr size_t most_mismatches = 100;

/// What later ones promise includes what earlier ones do.
constexpr std::array<std::string_view, 4> durabilities{
    "volatile", "transient_local", "transient", "persistent"};

std::ptrdiff_t rank(const std::string& durability) {
  return std::find(durabilities.begin(), durabilities.end(), durability)
         - durabilities.begin();
}

std::string name_of(const topic_end& x) {
  return x.program.empty() ? "a program" : "'" + x.program + "'";
}

/// Why the two do not match; empty: they do.
std::string mismatch(const topic_end& writer, const topic_end& reader) {
  const auto differ = [&](const std::string& wanted,
                          const std::string& offered) {
    return name_of(reader) + " wants " + wanted + ", but " + name_of(writer)
           + " offers " + offered + ": nothing is sent from this one to that";
  };
  if (reader.reliability == "reliable" && writer.reliability != "reliable")
    return differ(reader.reliability, writer.reliability);
  if (rank(reader.durability) > rank(writer.durability))
    return differ(reader.durability, writer.durability);
  return {};
}

void find_mismatches(topic_row& row) {
  for (const auto& writer : row.writers)
    for (const auto& reader : row.readers)
      if (auto why = mismatch(writer, reader);
          !why.empty() && row.mismatches.size() < most_mismatches)
        row.mismatches.push_back(std::move(why));
}

/// Ends of one name and different types do not match either.
void find_other_types(std::vector<topic_row>& rows) {
  for (auto& x : rows)
    for (const auto& y : rows)
      if (x.topic == y.topic && x.data_type != y.data_type && !x.readers.empty()
          && !y.writers.empty())
        x.mismatches.push_back(
            name_of(x.readers.front()) + " reads " + x.data_type + ", but "
            + name_of(y.writers.front()) + " writes " + y.data_type + " there");
}

} // namespace

std::vector<io_endpoint> written_topics(ros_graph& graph) {
  std::vector<io_endpoint> result;
  for (auto& x : graph.endpoints())
    if (x.writes)
      result.push_back({std::string{protocols::ros2}, std::move(x.topic),
                        std::move(x.data_type), "", false});
  return result;
}

std::vector<topic_row> topic_rows(const std::vector<graph_endpoint>& ends,
                                  const std::string& topic) {
  std::map<std::pair<std::string, std::string>, topic_row> rows;
  for (const auto& x : ends) {
    if (!topic.empty() && x.topic != topic)
      continue;
    auto& row = rows[{x.topic, x.data_type}];
    row.topic = x.topic;
    row.data_type = x.data_type;
    (x.writes ? row.writers : row.readers)
        .push_back(
            {x.program, x.reliable ? "reliable" : "best_effort", x.durability});
  }
  std::vector<topic_row> result;
  for (auto& [key, row] : rows) {
    find_mismatches(row);
    result.push_back(std::move(row));
  }
  find_other_types(result);
  return result;
}

} // namespace roscell
