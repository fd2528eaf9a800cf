#pragma once

#include <roscell/skill.hpp>

/// Turns lines of text with a temperature in degrees Celsius into messages
/// lab_msgs/msg/Reading, with a verdict.
class thermometer : public roscell::engine::executor {
public:
  explicit thermometer(const roscell::engine::environment& env);

  void process(const roscell::engine::frame& input,
               roscell::engine::emitter& output) override;

  void release() override;

private:
  const double warm_c_;
  const double hot_c_;
};
