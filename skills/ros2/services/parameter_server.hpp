#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/parameter_view.hpp"
#include "skills/ros2/participant.hpp"
#include "skills/ros2/services/parameter_answers.hpp"

#include <fastdds/rtps/common/SampleIdentity.h>

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace roscell::ros2 {

/// Answers the parameter services of the skill's ROS 2 node, as rmw_fastrtps
/// does: a request names the reader that waits for the reply, and the reply
/// names the request. On a thread of its own, for a reply waits until that
/// reader is known here, which the thread of DDS finds out.
class parameter_server : public engine::parameter_view {
public:
  /// Longest request that is looked at, and how many may wait.
  static constexpr std::size_t most_request_bytes = 64UL * 1024;
  static constexpr std::size_t most_waiting = 64;

  /// A reader that is not known for so long gets no reply; its client asks
  /// again.
  static constexpr std::chrono::milliseconds reader_patience{500};

  parameter_server(const engine::environment& env,
                   std::shared_ptr<shared_participant> shared,
                   engine::say_function say);

  ~parameter_server() override;

  void open(const engine::parameters& now) override;
  void show(const engine::parameters& now) override;
  void suspend() override;
  void resume(const engine::changed_variables& reported) override;

private:
  using identity = eprosima::fastrtps::rtps::SampleIdentity;

  /// The two ends of one service.
  struct service;

  struct request {
    service* of;
    identity from;
    std::string payload;
  };

  void begin();
  void run();
  void take(service& of, dds::DataReader& from);
  void answer(std::unique_lock<std::mutex>& guard, const request& x);

  const engine::parameters options_;
  const std::shared_ptr<shared_participant> shared_;
  const engine::say_function say_;
  std::shared_ptr<participant> participant_;
  std::vector<std::unique_ptr<service>> services_;
  std::mutex mutex_; // Guards what follows, and what services know of readers.
  std::condition_variable changed_;
  parameter_answers answers_;
  std::deque<request> waiting_;
  bool stopping_ = false;
  std::thread thread_;
};

} // namespace roscell::ros2
