#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/parameter_view.hpp"
#include "skills/ros2/participant.hpp"
#include "skills/ros2/services/parameter_answers.hpp"

#include <fastdds/rtps/common/SampleIdentity.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace roscell::ros2 {

/// Answers the parameter services of the skill's ROS 2 node, as rmw_fastrtps
/// does: a request names the reader that waits for the reply, and the reply
/// names the request. On a thread of its own, for a reply waits until that
/// reader is known here, which the thread of DDS finds out.
///
/// What a client sets is asked of the cell, where that lets it, and answered
/// once the cell has; meanwhile the other services go on.
class parameter_server : public engine::parameter_view {
public:
  /// Longest request that is looked at, and how many may wait.
  static constexpr std::size_t most_request_bytes = 64UL * 1024;
  static constexpr std::size_t most_waiting = 64;

  /// A reader that is not known for so long gets no reply; its client asks
  /// again.
  static constexpr std::chrono::milliseconds reader_patience{500};

  /// How long the cell has for a change; its node has less.
  static constexpr std::chrono::seconds cell_patience{25};

  parameter_server(const engine::environment& env,
                   std::shared_ptr<shared_participant> shared,
                   engine::say_function say, engine::request_function ask_cell);

  ~parameter_server() override;

  void open(const engine::parameters& now) override;
  void show(const engine::parameters& now) override;
  void on_answer(std::int64_t request, const std::string& problem) override;
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

  /// What the cell was asked for. There is one at a time.
  struct open_request {
    std::int64_t number;
    parameter_request wanted;
    request from;
    std::chrono::steady_clock::time_point until;
    std::optional<std::string> problem; ///< None: no answer has come.
  };

  using lock = std::unique_lock<std::mutex>;

  void begin();
  void run();
  void wait_for_work(lock& guard);
  void take(service& of, dds::DataReader& from);
  void answer(lock& guard, const request& x);
  void begin_request(lock& guard, const request& x);
  void end_request(lock& guard);
  static void reply(lock& guard, const request& x, std::string text);

  const engine::parameters options_;
  const std::shared_ptr<shared_participant> shared_;
  const engine::say_function say_;
  const engine::request_function ask_cell_; ///< Empty: nothing may be set.
  std::shared_ptr<participant> participant_;
  std::vector<std::unique_ptr<service>> services_;
  std::mutex mutex_; // Guards what follows, and what services know of readers.
  std::condition_variable changed_;
  parameter_answers answers_;
  std::deque<request> waiting_;
  std::optional<open_request> open_;
  bool stopping_ = false;
  std::thread thread_;
};

} // namespace roscell::ros2
