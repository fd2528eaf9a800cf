#include "actors/edge/history/event_lines.hpp"

#include <cstdlib>
#include <string_view>

/// What is read as an event is written as a line from which the same is read.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const std::string_view line{reinterpret_cast<const char*>(data), size};
  const auto number = number_of(line);
  const auto found = event_of(line);
  if (!found)
    return 0;
  if (number != found->sequence)
    std::abort();
  auto again = line_of(*found);
  again.pop_back();
  const auto second = event_of(again);
  if (!second || !(*second == *found))
    std::abort();
  return 0;
}
