#pragma once

#include "actors/edge/dds/ros_graph.hpp"
#include "messages/instance.hpp"
#include "messages/topic.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// Which instances have an input that gets nothing although its writer goes on
/// sending. Pure, and no larger than what it is asked to judge.
///
/// Both ends of a stream are compared by what their skills have counted: the
/// writer what it has written, the reader what has reached it, before anything
/// waits or is dropped there. A reader that is busy is not starved. A writer
/// counts once it has sent three frames in each ten seconds for ten seconds:
/// the words of both ends may be some seconds apart. Streams are those of ROS 2
/// topics between steps of the cell, whichever tasks they are of: a topic has
/// one name in all of it. What nobody writes is no fault.
class stream_watch {
public:
  /// What a reader must have had nothing for, and a writer have sent for.
  static constexpr double long_enough_s = 10;

  /// Judges all that is known now. Of a node that is not among `reported`
  /// nobody knows the metrics: an instance there, or with a silent input that
  /// only such nodes may write, is judged as before. Returns the instances of
  /// which the judgement has changed; those that do not run are forgotten
  /// without a word.
  std::vector<std::string> judge(const std::vector<const instance_row*>& rows,
                                 const std::set<std::string>& reported);

  /// One sentence, or null if the instance is not starved.
  const std::string* reason_of(const std::string& instance) const;

  /// It does not run any more.
  void forget(const std::string& instance) {
    reasons_.erase(instance);
  }

private:
  std::map<std::string, std::string> reasons_; ///< By instance.
};

/// Where `some` of all instances are, and where the topics that they read are
/// written: whom to ask before they are judged.
std::set<std::string>
nodes_around(const std::vector<const instance_row*>& all,
             const std::vector<const instance_row*>& some);

/// The topics that somebody writes, an entry a writer.
std::vector<io_endpoint> written_topics(ros_graph& graph);

/// The topics in these ends, by name and type; of `topic` alone unless it is
/// empty. Tells of pairs that will never match: by DDS 1.4, 2.2.3, a reader may
/// want no more of reliability and durability than its writer offers.
std::vector<topic_row> topic_rows(const std::vector<graph_endpoint>& ends,
                                  const std::string& topic);

} // namespace roscell
