#pragma once

#include <array>
#include <cstddef>

constexpr std::size_t joints = 6;

/// Angles of the joints from base to wrist, in rad.
using joint_angles = std::array<double, joints>;

/// A position in the base's frame, in m.
struct position {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A simulated arm with six joints, of which the first three place the wrist.
/// Each follows its target with a bounded speed.
class arm {
public:
  void move_towards(const joint_angles& target) {
    target_ = target;
  }

  /// Moves on by `seconds`.
  void step(double seconds);

  /// Where it stands.
  const joint_angles& angles() const {
    return angles_;
  }

  position wrist() const;

private:
  joint_angles angles_{};
  joint_angles target_{};
};

/// The angles that bring the wrist to `goal`, or as near as it can be.
joint_angles reach(const position& goal);
