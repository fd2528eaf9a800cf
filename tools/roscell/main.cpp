#include "tools/roscell/commands.hpp"

int main(int argc, char** argv) {
  return roscell::cli::run(argc, argv);
}
