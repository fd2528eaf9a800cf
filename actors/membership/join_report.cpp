#include "actors/membership/join_report.hpp"

#include "actors/membership/limits.hpp"

#include <algorithm>

namespace roscell {

join_report::join_report() : pause_{limits::membership::complaint_pause} {
  // nop
}

void join_report::begin(const std::string& address, int64_t now_unix_ms) {
  if (rows_.empty())
    rows_.emplace_back();
  auto& row = rows_.front();
  if (row.address != address) {
    row.address = address;
    row.problem.clear();
    row.hint.clear();
  }
  ++row.attempts;
  row.tried_unix_ms = now_unix_ms;
}

bool join_report::note(const std::string& problem, const std::string& hint,
                       time_point now) {
  if (rows_.empty())
    return false;
  rows_.front().problem = problem;
  rows_.front().hint = hint;
  // Who provokes ever new problems is told of like any other.
  const bool news = reported_.size() < limits::membership::complaints
                    && reported_.insert(problem).second;
  if (!news && now < next_)
    return false;
  if (!news || reported_.size() == 1) {
    next_ = now + pause_;
    pause_ = std::min<std::chrono::milliseconds>(
        2 * pause_, limits::membership::longest_complaint_pause);
  }
  return true;
}

void join_report::clear() {
  *this = join_report{};
}

} // namespace roscell
