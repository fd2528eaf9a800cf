#include "actors/cell/cell_topics.hpp"

#include "messages/stream_protocols.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

namespace roscell {

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
