#pragma once

#include "test/site/site.hpp"

namespace roscell::test {

/// Starts the actors of a party whose edge lives, as
/// actors/node/node_builder.cpp does.
void start_parts(site& place, site_party& x);

} // namespace roscell::test
