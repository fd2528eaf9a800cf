#pragma once

#include "messages/failure.hpp"
#include "messages/skill.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// A build that was removed from the cell, while nodes may still have it.
struct build_remains {
  std::string hash;
  std::vector<std::string> nodes; ///< Those that have not let it go yet.
  int64_t removed_unix_ms = 0;

  static constexpr auto fields() {
    return field_list{
        required("hash", &build_remains::hash),
        required("nodes", &build_remains::nodes),
        required("removed_unix_ms", &build_remains::removed_unix_ms)};
  }
};

/// The builds that were added to the cell, by hash. They are asked for when a
/// person looks or a task is placed, so what a skill says of itself is kept
/// packed, which takes a third of the memory. Pure.
class cell_builds {
public:
  /// Why it cannot be one of the cell's, if so: another build has that version
  /// for the same architecture, or there are too many.
  std::optional<failure> refusal(const cell_build& x) const;

  /// What remains of it elsewhere may stay.
  void add(const cell_build& x);

  /// @param remains where it has to go yet.
  void remove(const build_remains& remains);
  void restore(const build_remains& remains);

  /// The builds that a node has to let go.
  std::vector<std::string> remains_on(const std::string& node) const;

  /// A node has let a build go. True: it was the last one.
  bool release(const std::string& hash, const std::string& node);

  /// Null: nothing remains of it.
  const build_remains* find_remains(const std::string& hash) const;

  /// None: it is none of the cell's.
  std::optional<cell_build> find(const std::string& hash) const;

  /// By operation, the newest first; an empty operation means all.
  std::vector<cell_build> of(const std::string& operation) const;

  size_t size() const;

private:
  struct packed_build {
    std::string operation;
    std::string version;
    std::string rest; ///< CBOR.
  };

  static cell_build unpack(const std::string& hash, const packed_build& x);

  std::map<std::string, packed_build> builds_;
  std::map<std::string, build_remains> remains_;
};

/// Whether a node of that architecture can run the build.
bool runs_on_architecture(const installed_skill& skill,
                          const std::string& architecture);

} // namespace roscell
