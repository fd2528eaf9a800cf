#include "skills/engine/run.hpp"
#include "skills/image_source/image_source.hpp"

int main(int argc, char** argv) {
  roscell::engine::registry parts;
  parts.add_executor<roscell::source::image_source>("folder");
  return roscell::engine::run(parts, argc, argv);
}
