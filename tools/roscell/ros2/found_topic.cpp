#include "tools/roscell/ros2/found_topic.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "client/columns.hpp"
#include "messages/node.hpp"
#include "messages/stream_protocols.hpp"
#include "roscell/skill/errors.hpp"
#include "tools/roscell/client/find_things.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace roscell::cli {

namespace {

constexpr std::chrono::seconds query_limit{10};

/// What a step of a task is to write, which no discovery server may know yet:
/// its program has just begun. Without a type nobody writes the topic.
topic_row declared_row(const node_client& node, const std::string& topic) {
  for (const auto& row : instances_in_cell(node))
    for (const auto& end : row.spec.output)
      if (end.protocol == protocols::ros2 && full_topic(end.endpoint) == topic
          && is_live(row.state))
        return {topic, end.data_type, {}, {}, {}};
  return {};
}

topic_row row_of(const node_client& node, const std::string& topic) {
  topic_query query;
  query.topic = topic;
  auto rows =
      node.ask(message_json(query), query_limit).get<topic_list>().topics;
  const auto written = std::find_if(rows.begin(), rows.end(),
                                    [](auto& x) { return !x.writers.empty(); });
  if (written != rows.end())
    return *written;
  auto declared = declared_row(node, full_topic(topic));
  if (declared.data_type.empty())
    throw command_error{exit_refused,
                        "nobody in the cell writes the topic '" + topic + "'",
                        "`roscell topics` lists what there is"};
  return declared;
}

/// A reader that wants what one of several writers does not offer would not
/// match that one; the last messages of those who keep them are wanted. Who
/// wants least matches whoever comes.
ros2::topic_qos qos_for(const topic_row& row) {
  const auto& xs = row.writers;
  ros2::topic_qos result;
  if (xs.empty()) {
    result.reliable = result.transient_local = false;
    return result;
  }
  result.reliable = std::all_of(xs.begin(), xs.end(), [](const auto& x) {
    return x.reliability == "reliable";
  });
  result.transient_local =
      std::none_of(xs.begin(), xs.end(),
                   [](const auto& x) { return x.durability == "volatile"; });
  return result;
}

} // namespace

void add_topic_choice(CLI::App& command, topic_choice& choice) {
  add_connection_options(command, choice.connection);
  command.add_option("TOPIC", choice.topic, "Its name")
      ->required()
      ->option_text(" ");
}

found_topic find_topic(const topic_choice& choice) {
  return find_topic(node_client{choice.connection}, choice.topic);
}

found_topic find_topic(const node_client& node, const std::string& topic) {
  const auto environment =
      node.get("/v1/node").get<node_description>().environment;
  if (environment.empty())
    throw command_error{exit_refused, "this node is in no cell, or not yet",
                        "`roscell status` shows where it stands"};
  const auto lookup = [&](const char* name) -> const char* {
    if (name == std::string{"ROSCELL_OPERATION"})
      return "roscell_listener";
    const auto i = environment.find(name);
    return i == environment.end() ? nullptr : i->second.c_str();
  };
  auto row = row_of(node, topic);
  const auto qos = qos_for(row);
  return {std::move(row),
          ros2::read_participant_config(lookup, engine::parameters{}), qos};
}

int listen(const std::function<int()>& command) {
  try {
    return command();
  } catch (const engine::start_error& why) {
    throw command_error{exit_refused, why.what()};
  }
}

std::string topics_view(const topic_list& topics, const view_style& style) {
  std::string mismatches;
  for (const auto& x : topics.topics)
    for (const auto& why : x.mismatches)
      mismatches += "\n" + printable(x.topic + ": " + why);
  if (topics.topics.empty())
    return "no topics\n";
  return table_of(topic_columns(), topics.topics, style).render(style.text)
         + (mismatches.empty() ? "" : mismatches + "\n");
}

} // namespace roscell::cli
