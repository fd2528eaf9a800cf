#include "messages/stream_counts.hpp"

#include <algorithm>
#include <string>

namespace roscell {

namespace {

const stream_count* count_at(const instance_row& row, const char* direction,
                             std::size_t number) {
  const auto end = direction + std::to_string(number);
  const auto& all = row.metrics.streams;
  const auto i = std::find_if(all.begin(), all.end(),
                              [&](const auto& x) { return x.end == end; });
  return i == all.end() ? nullptr : &*i;
}

} // namespace

const stream_count* input_count(const instance_row& row, std::size_t number) {
  return count_at(row, "input:", number);
}

const stream_count* output_count(const instance_row& row, std::size_t number) {
  return count_at(row, "output:", number);
}

} // namespace roscell
