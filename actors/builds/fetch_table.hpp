#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// Which piece of a build is asked of whom: several sources at once, each for
/// what few others have, and of one that fails or lies no more. Pure: it is
/// told what has happened.
class fetch_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// What is asked next.
  struct question {
    size_t piece = 0;
    std::string source;
  };

  /// A source that is asked no more, and why.
  struct lost_source {
    std::string source;
    std::string why;
  };

  /// @param have the pieces that are here already.
  /// @param seed makes nodes that begin together begin with other pieces, so
  ///   that they have something for each other.
  fetch_table(std::vector<bool> have, uint64_t seed);

  /// A node that may be asked. What it has is not known before `announce`;
  /// until then it is taken to have nothing.
  void add_source(const std::string& source);

  /// The source has these pieces, as it says. One of another length is a lie.
  void announce(const std::string& source, std::vector<bool> pieces);

  /// What to ask now; it counts as asked. Empty: nothing, at present. When what
  /// is being asked for has become slow there may be more.
  std::vector<question> next(time_point now);

  /// A piece came, whole and right. True if it is new.
  bool take(const question& answered);

  /// The source gave other bytes than the manifest says: it is lost.
  void blame(const question& answered, const std::string& why);

  /// The source did not answer, or has not got it; after some in a row it is
  /// lost.
  void fail(const question& asked, const std::string& why);

  /// All that the source was asked for is open again.
  void drop_source(const std::string& source, const std::string& why);

  bool complete() const;

  /// Nobody is left who could be asked.
  bool stranded() const;

  size_t pieces_here() const;
  const std::vector<bool>& here() const;
  const std::vector<lost_source>& lost() const;

  /// How many pieces each source has given, the lost ones too.
  const std::map<std::string, size_t>& given() const;

private:
  struct source_state {
    std::vector<bool> has;
    std::map<size_t, time_point> asked; ///< Pieces, and since when.
    int failures = 0;                   ///< In a row.
  };

  std::optional<size_t> choose(const source_state& source,
                               time_point now) const;
  size_t holders_of(size_t piece) const;
  std::optional<time_point> asked_last(size_t piece) const;

  std::vector<bool> here_;
  std::vector<size_t> order_; ///< The pieces, shuffled.
  std::map<std::string, source_state> sources_;
  std::vector<lost_source> lost_;
  std::map<std::string, size_t> given_;
};

} // namespace roscell
