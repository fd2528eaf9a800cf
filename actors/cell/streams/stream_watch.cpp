#include "actors/cell/streams/stream_watch.hpp"

#include "messages/stream_counts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roscell {

namespace {

using row_list = std::vector<const instance_row*>;

/// Somebody writes this topic; `row` may write several.
struct written_topic {
  const instance_row* row;
  size_t output;
};

/// The writers of each topic of one task.
using topic_writers = std::multimap<std::string, written_topic>;

bool is_topic(const io_endpoint& x) {
  return x.protocol == "ros2";
}

topic_writers writers_in(const row_list& task) {
  topic_writers result;
  for (const auto* row : task)
    for (size_t i = 0; i < row->spec.output.size(); ++i)
      if (is_topic(row->spec.output[i]))
        result.insert({row->spec.output[i].endpoint, {row, i}});
  return result;
}

bool goes_on_sending(const written_topic& x) {
  const auto* count = output_count(*x.row, x.output);
  return count != nullptr && count->steady_s >= stream_watch::long_enough_s;
}

std::string sentence_on(const io_endpoint& input, const stream_count& count,
                        const instance_row& writer) {
  return "input '" + input.endpoint + "' has had no frame "
         + (count.frames == 0 ? "at all"
                              : "for "
                                    + std::to_string(static_cast<int64_t>(
                                        std::floor(count.quiet_s)))
                                    + " s")
         + ", though step '" + writer.spec.step + "' on node '" + writer.node
         + "' goes on sending; `roscell topics` and `roscell doctor` look for "
           "the cause";
}

/// What is to be said of one instance; empty: it gets what is sent.
std::string reason_for(const instance_row& row, const topic_writers& writers) {
  for (size_t i = 0; i < row.spec.input.size(); ++i) {
    const auto& input = row.spec.input[i];
    const auto* count = input_count(row, i);
    if (!is_topic(input) || count == nullptr
        || count->quiet_s < stream_watch::long_enough_s)
      continue;
    const auto [first, last] = writers.equal_range(input.endpoint);
    const auto sender = std::find_if(first, last, [&](const auto& x) {
      return x.second.row != &row && goes_on_sending(x.second);
    });
    if (sender != last)
      return sentence_on(input, *count, *sender->second.row);
  }
  return {};
}

/// Whether all that counts for its judgement has just been told.
bool is_told(const instance_row& row, const topic_writers& writers,
             const std::set<std::string>& told) {
  if (told.count(row.node) == 0)
    return false;
  for (const auto& input : row.spec.input) {
    const auto [first, last] = writers.equal_range(input.endpoint);
    if (std::any_of(first, last, [&](const auto& x) {
          return told.count(x.second.row->node) == 0;
        }))
      return false;
  }
  return true;
}

std::map<std::string, row_list> by_task(const row_list& rows) {
  std::map<std::string, row_list> result;
  for (const auto* row : rows)
    if (row->state == instance_state::running)
      result[row->spec.task].push_back(row);
  return result;
}

} // namespace

std::vector<std::string>
stream_watch::judge(const row_list& rows, const std::set<std::string>& told) {
  const auto before = std::exchange(reasons_, {});
  std::vector<std::string> result;
  for (const auto& [task, members] : by_task(rows)) {
    const auto writers = writers_in(members);
    for (const auto* row : members) {
      const auto& id = row->spec.instance;
      const auto known = before.find(id);
      const bool was_starved = known != before.end();
      auto reason = is_told(*row, writers, told) ? reason_for(*row, writers)
                    : was_starved                ? known->second
                                                 : std::string{};
      if (reason.empty() == was_starved)
        result.push_back(id);
      if (!reason.empty())
        reasons_[id] = std::move(reason);
    }
  }
  return result;
}

const std::string* stream_watch::reason_of(const std::string& instance) const {
  const auto known = reasons_.find(instance);
  return known == reasons_.end() ? nullptr : &known->second;
}

} // namespace roscell
