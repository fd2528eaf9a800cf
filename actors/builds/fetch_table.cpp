#include "actors/builds/fetch_table.hpp"

#include "actors/builds/limits.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

namespace roscell {

fetch_table::fetch_table(std::vector<bool> have, uint64_t seed)
    : here_(std::move(have)), order_(here_.size()) {
  std::iota(order_.begin(), order_.end(), size_t{0});
  std::shuffle(order_.begin(), order_.end(), std::mt19937_64{seed});
}

void fetch_table::add_source(const std::string& source) {
  sources_.try_emplace(source);
}

void fetch_table::announce(const std::string& source,
                           std::vector<bool> pieces) {
  const auto found = sources_.find(source);
  if (found == sources_.end())
    return;
  if (pieces.size() != here_.size())
    return drop_source(source, "it tells of another number of pieces");
  found->second.has = std::move(pieces);
}

std::vector<fetch_table::question> fetch_table::next(time_point now) {
  std::vector<question> result;
  const auto at_a_time = sources_.size() <= limits::build::few_sources
                             ? limits::build::questions_of_source
                             : 1;
  size_t open = 0;
  for (const auto& [name, source] : sources_)
    open += source.asked.size();
  for (auto& [name, source] : sources_) {
    while (source.asked.size() < at_a_time
           && open < limits::build::questions_of_fetch) {
      const auto piece = choose(source, now);
      if (!piece)
        break;
      source.asked[*piece] = now;
      result.push_back({*piece, name});
      ++open;
    }
  }
  return result;
}

bool fetch_table::take(const question& answered) {
  const auto found = sources_.find(answered.source);
  if (found != sources_.end()) {
    found->second.asked.erase(answered.piece);
    found->second.failures = 0;
  }
  if (here_.at(answered.piece))
    return false;
  here_[answered.piece] = true;
  ++given_[answered.source];
  return true;
}

void fetch_table::blame(const question& answered, const std::string& why) {
  drop_source(answered.source, why);
}

void fetch_table::fail(const question& asked, const std::string& why) {
  const auto found = sources_.find(asked.source);
  if (found == sources_.end())
    return;
  found->second.asked.erase(asked.piece);
  if (++found->second.failures >= limits::build::failures_in_a_row)
    drop_source(asked.source, why);
}

void fetch_table::drop_source(const std::string& source,
                              const std::string& why) {
  if (sources_.erase(source) != 0)
    lost_.push_back({source, why});
}

bool fetch_table::complete() const {
  return std::find(here_.begin(), here_.end(), false) == here_.end();
}

bool fetch_table::stranded() const {
  return !complete() && sources_.empty();
}

size_t fetch_table::pieces_here() const {
  return static_cast<size_t>(std::count(here_.begin(), here_.end(), true));
}

const std::vector<bool>& fetch_table::here() const {
  return here_;
}

const std::vector<fetch_table::lost_source>& fetch_table::lost() const {
  return lost_;
}

const std::map<std::string, size_t>& fetch_table::given() const {
  return given_;
}

/// Of the pieces that the source has and nobody is asked for, the one that the
/// fewest have. Where all that is left is asked for already, one that is slow
/// to come: what comes twice takes the room of what others wait for.
std::optional<size_t> fetch_table::choose(const source_state& source,
                                          time_point now) const {
  std::optional<size_t> rarest;
  std::optional<size_t> slow;
  size_t fewest = 0;
  for (const auto piece : order_) {
    if (here_[piece] || piece >= source.has.size() || !source.has[piece]
        || source.asked.count(piece) != 0)
      continue;
    if (const auto asked = asked_last(piece)) {
      if (*asked + limits::build::slow <= now)
        slow = piece;
      continue;
    }
    const auto holders = holders_of(piece);
    if (!rarest || holders < fewest) {
      rarest = piece;
      fewest = holders;
    }
    if (fewest == 1)
      break; // Nothing is rarer.
  }
  return rarest ? rarest : source.asked.empty() ? slow : std::nullopt;
}

size_t fetch_table::holders_of(size_t piece) const {
  size_t result = 0;
  for (const auto& [name, source] : sources_)
    if (piece < source.has.size() && source.has[piece])
      ++result;
  return result;
}

/// When somebody was last asked for a piece that is on its way.
std::optional<fetch_table::time_point>
fetch_table::asked_last(size_t piece) const {
  std::optional<time_point> result;
  for (const auto& [name, source] : sources_)
    if (const auto i = source.asked.find(piece);
        i != source.asked.end() && (!result || *result < i->second))
      result = i->second;
  return result;
}

} // namespace roscell
