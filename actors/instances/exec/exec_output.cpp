#include "actors/instances/exec/exec_output.hpp"

#include "actors/edge/exec/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

void exec_backlog::add(bool of_errors, std::string bytes) {
  if (bytes.empty())
    return;
  size_ += bytes.size();
  // Small parts in a row become one; a large one is left as it came.
  auto* last = runs_.empty() ? nullptr : &runs_.back();
  if (last != nullptr && last->of_errors == of_errors
      && last->bytes.size() + bytes.size() <= limits::exec::part_bytes)
    last->bytes += bytes;
  else
    runs_.push_back({of_errors, std::move(bytes)});
}

bool exec_backlog::has_room() const {
  return size_ < limits::exec::waiting_bytes;
}

bool exec_backlog::acknowledge(int64_t offset) {
  if (offset < begin_ || offset > begin_ + static_cast<int64_t>(size_))
    return false;
  auto left = static_cast<size_t>(offset - begin_);
  begin_ = offset;
  size_ -= left;
  while (left > 0) {
    auto& first = runs_.front().bytes;
    const auto taken = std::min(left, first.size());
    left -= taken;
    if (taken == first.size())
      runs_.pop_front();
    else
      first.erase(0, taken);
  }
  return true;
}

exec_backlog::part exec_backlog::front() const {
  if (runs_.empty())
    return {"", false, begin_, true};
  const auto& first = runs_.front();
  part result{first.bytes.substr(0, limits::exec::part_bytes), first.of_errors,
              begin_, false};
  result.next_offset += static_cast<int64_t>(result.bytes.size());
  result.is_last = result.bytes.size() == size_;
  return result;
}

} // namespace roscell
