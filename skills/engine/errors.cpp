#include "roscell/skill/errors.hpp"

namespace roscell::engine {

std::string current_error() {
  try {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

} // namespace roscell::engine
