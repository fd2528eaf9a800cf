#include "actors/edge/dds/ros_graph.hpp"

#include "actors/edge/dds/lives/server_lives.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

constexpr std::string_view topic_prefix = "rt/";
constexpr std::string_view message_part = "::msg::dds_::";

/// `sensor_msgs/msg/Image` of `sensor_msgs::msg::dds_::Image_`; empty for any
/// other type.
std::string message_type(const std::string& type) {
  const auto part = type.find(message_part);
  if (part == std::string::npos || type.back() != '_')
    return {};
  const auto name = part + message_part.size();
  return type.substr(0, part) + "/msg/"
         + type.substr(name, type.size() - name - 1);
}

guid_prefix prefix_of(const endpoint_guid& x) {
  guid_prefix result{};
  std::copy_n(x.begin(), result.size(), result.begin());
  return result;
}

} // namespace

participant_counts ros_graph::participants() {
  const std::lock_guard guard{mutex_};
  participant_counts result;
  for (const auto& [who, name] : names_)
    ++(server_lives::is_server(who) ? result.servers : result.programs);
  return result;
}

void ros_graph::name_participant(const guid_prefix& who,
                                 const std::string& name) {
  {
    const std::lock_guard guard{mutex_};
    if (names_.size() >= most_participants && names_.count(who) == 0)
      return;
    names_[who] = name;
  }
  report_change();
}

void ros_graph::remove_participant(const guid_prefix& who) {
  {
    const std::lock_guard guard{mutex_};
    names_.erase(who);
    for (auto i = endpoints_.begin(); i != endpoints_.end();)
      i = prefix_of(i->first) == who ? endpoints_.erase(i) : std::next(i);
  }
  report_change();
}

void ros_graph::add(const endpoint_guid& which, graph_endpoint end) {
  end.data_type = message_type(end.data_type);
  if (end.topic.rfind(topic_prefix, 0) != 0 || end.data_type.empty())
    return;
  end.topic.erase(0, topic_prefix.size() - 1);
  {
    const std::lock_guard guard{mutex_};
    if (endpoints_.size() >= most_endpoints && endpoints_.count(which) == 0)
      return;
    endpoints_[which] = std::move(end);
  }
  report_change();
}

void ros_graph::remove(const endpoint_guid& which) {
  {
    const std::lock_guard guard{mutex_};
    if (endpoints_.erase(which) == 0)
      return;
  }
  report_change();
}

void ros_graph::begin_service() {
  {
    const std::lock_guard guard{mutex_};
    ++servers_;
  }
  report_change();
}

void ros_graph::end_service() {
  {
    const std::lock_guard guard{mutex_};
    if (--servers_ == 0) {
      names_.clear();
      endpoints_.clear();
    }
  }
  report_change();
}

bool ros_graph::is_served() {
  const std::lock_guard guard{mutex_};
  return servers_ > 0;
}

std::vector<graph_endpoint> ros_graph::endpoints() {
  const std::lock_guard guard{mutex_};
  reported_ = false;
  std::vector<graph_endpoint> result;
  for (const auto& [guid, end] : endpoints_) {
    result.push_back(end);
    if (const auto i = names_.find(prefix_of(guid)); i != names_.end())
      result.back().program = i->second;
  }
  return result;
}

void ros_graph::watch(std::function<void()> on_change) {
  {
    const std::lock_guard guard{mutex_};
    on_change_ = std::move(on_change);
    reported_ = false;
  }
  report_change();
}

void ros_graph::report_change() {
  std::function<void()> call;
  {
    const std::lock_guard guard{mutex_};
    if (reported_ || !on_change_)
      return;
    reported_ = true;
    call = on_change_;
  }
  call();
}

} // namespace roscell
