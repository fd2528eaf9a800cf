#pragma once

#include "actors/edge/host/interfaces.hpp"

#include <istream>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

namespace roscell::cli {

/// What a node is to use: the name of an interface, which may come later, or an
/// address that this host has now. If `wanted` is empty, a terminal is asked;
/// without one, and for what can be neither, command_error lists what there is.
std::string choose_interface(const std::string& wanted);

/// Asks a person to pick one of `all` by its number; asks again after an
/// answer that is none. Throws command_error when the answers end.
interface_address ask_for_interface(const std::vector<interface_address>& all,
                                    std::istream& answers, std::ostream& out);

/// Whether `text` is an address and no name.
bool is_ipv4_address(const std::string& text);

/// All interfaces of this host, those without an address, too.
std::string describe_links(const std::vector<interface_address>& all,
                           const std::vector<host_link>& links);

/// The address that `wanted` has now or, in a sentence without a full stop,
/// what it lacks.
std::variant<interface_address, std::string>
find_interface(const std::string& wanted, bool with_carrier,
               const std::vector<interface_address>& all,
               const std::vector<host_link>& links);

} // namespace roscell::cli
