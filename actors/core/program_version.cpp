#include "actors/core/program_version.hpp"

namespace roscell {

const char* const program_version = ROSCELL_VERSION;

} // namespace roscell
