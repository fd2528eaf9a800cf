#pragma once

#include "dds/server_ids.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// Through whom this node's discovery server knows the participants that it
/// knows, and which of them are in doubt. The diagram is in docs/protocols.md.
///
/// Fast DDS forgets nobody whom another server has told of: if that one ends
/// without a farewell, what it told of stays for ever. Here such participants
/// come into doubt: they go on, because programs outlive a node that ends. The
/// server's next life tells of those that are there, which ends the doubt.
class participant_table {
public:
  /// More than these are not remembered.
  static constexpr std::size_t most = 4096;

  /// Server `id` has told of it.
  void reported_by(std::uint8_t id, const guid_prefix& who);

  /// It has told of itself, so that nobody else is needed to know it.
  void reported_itself(const guid_prefix& who);

  /// It is known.
  void appeared(const guid_prefix& who);

  /// It is not known any more.
  void gone(const guid_prefix& who);

  /// All that server `id` has told of is in doubt.
  void doubt(std::uint8_t id);

  /// Of server `id`, what is in doubt.
  std::vector<guid_prefix> doubted(std::uint8_t id) const;

  /// All that server `id` has told of.
  std::vector<guid_prefix> reported_by(std::uint8_t id) const;

  /// Whether that participant is known by what server `id` has told.
  bool was_reported_by(std::uint8_t id, const guid_prefix& who) const;

private:
  struct reporter {
    std::uint8_t id = 0;
    bool doubted = false;
  };

  std::map<guid_prefix, reporter> reported_;
  std::set<guid_prefix> selves_; // Known by what they tell themselves.
};

} // namespace roscell
