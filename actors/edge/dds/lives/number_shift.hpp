#pragma once

#include "actors/edge/dds/lives/number_reserve.hpp"
#include "dds/server_ids.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// Lets a discovery server, which Fast DDS begins at 1 in each life, go on
/// where its last life ended: what it numbers is shifted by what that one has
/// used, and its counts are those of the reserve (number_reserve.hpp).
class number_shift {
public:
  /// Takes what it needs for one life.
  number_shift(const guid_prefix& self,
               std::shared_ptr<number_reserve> reserve);

  /// Shifts what a message says of the own writers' numbers.
  void let_out(std::uint8_t* message, std::size_t size) const;

  /// Shifts back what another one says of them. Numbers of earlier lives are
  /// none of this one's: whoever expects such a one has got nothing yet.
  void take_in(std::uint8_t* message, std::size_t size) const;

private:
  const guid_prefix self_;
  const std::shared_ptr<number_reserve> reserve_;
  const std::int64_t begin_;
};

} // namespace roscell
