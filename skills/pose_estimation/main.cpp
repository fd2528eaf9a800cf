#include "skills/engine/run.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"

int main(int argc, char** argv) {
  roscell::engine::registry parts;
  parts.add_executor<roscell::pose::pose_estimator>("apriltag3");
  return roscell::engine::run(parts, argc, argv);
}
