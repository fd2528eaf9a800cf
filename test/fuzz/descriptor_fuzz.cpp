// Arbitrary bytes as a skill descriptor.
#include "messages/skill.hpp"
#include "test/fuzz/fuzz_support.hpp"

using namespace roscell;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto document = fuzz::parse(bytes, size);
  if (!document)
    return 0;
  if (auto why = validate_document("skill_descriptor", *document)) {
    fuzz::check_refusal(*why);
    return 0;
  }
  const auto skill = fuzz::check_decoding<skill_descriptor>(*document);
  if (skill.engine == "actor") {
    if (!skill.ros2.empty() || !skill.entry_point.empty())
      fuzz::found("a program for an actor", *document);
    return 0;
  }
  const bool is_stock = skill.engine == "ros2_standalone";
  if (is_stock == skill.ros2.empty() || is_stock != skill.entry_point.empty())
    fuzz::found("neither one program of the folder nor one of ROS 2",
                *document);
  if (is_stock)
    return 0;
  const auto& program = skill.entry_point.front();
  if (program.front() == '/'
      || ("/" + program + "/").find("/../") != program.npos)
    fuzz::found("a program outside of the skill's folder", *document);
  return 0;
}
