#pragma once

#include "actors/edge/host/interfaces.hpp"

#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace roscell::cli {

/// The address that `wanted`, an interface or an address, means. If it is
/// empty, a terminal is asked; without one, command_error lists what there is.
interface_address choose_interface(const std::string& wanted);

/// Asks a person to pick one of `all` by its number; asks again after an
/// answer that is none. Throws command_error when the answers end.
interface_address ask_for_interface(const std::vector<interface_address>& all,
                                    std::istream& answers, std::ostream& out);

} // namespace roscell::cli
