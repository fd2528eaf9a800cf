#include "move_to.hpp"

#include <roscell/ros2/cdr.hpp>
#include <roscell/ros2/geometry_msgs.hpp>
#include <roscell/ros2/tf2_msgs.hpp>

#include <string>

namespace {

namespace ros2 = roscell::ros2;

constexpr const char* descriptor = R"(
operation: move_to
engine: actor
input: {data_types: [tf2_msgs/msg/TFMessage], protocols: [ros2, actor]}
output: {data_types: [geometry_msgs/msg/PointStamped], protocols: [ros2, actor]}
models:
  - name: six_axis
    parameters:
      height_m:
        type: number
        default: 0.1
        minimum: 0
        maximum: 1
        unit: m
        description: How far above the tag the wrist stops.
    deployments:
      - name: controller
        architectures: [amd64, arm64]
        resources: {cpu: 0.1, memory_mib: 16, disk_mib: 0}
)";

/// One instance. All its handlers run one at a time.
class mover {
public:
  mover(control_loop& loop, roscell::actor_skill_context context)
      : loop_(loop), context_(std::move(context)),
        height_m_(
            context_.environment().parameters.number("height_m", 0.1, 0, 1)) {
    context_.log("moves the arm");
    context_.ready();
  }

  void move(const roscell::skill_frame& x) {
    const auto message =
        ros2::deserialize<ros2::tf2_msgs::tf_message>(x.data->payload);
    if (message.transforms.empty())
      return;
    const auto& to = message.transforms.front().transform.translation;
    loop_.go_to({to.x, to.y, to.z + height_m_});
    report(message.transforms.front().header);
  }

  /// The arm stays where it is.
  void hold() {
    loop_.go_to(loop_.wrist());
    context_.log("the arm holds");
  }

private:
  void report(const ros2::std_msgs::header& header) {
    if (context_.environment().outputs.empty())
      return;
    const auto at = loop_.wrist();
    ros2::geometry_msgs::point_stamped result;
    result.header = header;
    result.point.x = at.x;
    result.point.y = at.y;
    result.point.z = at.z;
    roscell::engine::frame out;
    out.payload = ros2::serialize(result);
    context_.emit(std::move(out));
  }

  control_loop& loop_;
  const roscell::actor_skill_context context_;
  const double height_m_;
};

} // namespace

roscell::actor_skill make_move_to(control_loop& loop) {
  return {descriptor,
          [&loop](roscell::actor_skill_instance::pointer,
                  roscell::actor_skill_context context)
              -> roscell::actor_skill_instance::behavior_type {
            auto x = std::make_shared<mover>(loop, std::move(context));
            return {
                [x](const roscell::skill_frame& frame) { x->move(frame); },
                [](roscell::check_life) {},
                [x](roscell::stop_skill) { x->hold(); },
            };
          }};
}
