#include "tools/roscell/commands.hpp"

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands/help.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

namespace roscell::cli {

namespace {

int print_version_mismatch(const std::exception& e) {
  print_error(std::string{"the answer is not of this version: "} + e.what(),
              "compare `roscell --version` here and there");
  return exit_unreachable;
}

/// Does what was chosen, and tells of what went wrong.
int perform(const action& chosen) {
  try {
    return chosen();
  } catch (const refused& e) {
    if (e.as_json)
      print(pretty(e.reply));
    else
      print_refusal(e.reply);
    return exit_code_of_refusal(e.reply);
  } catch (const command_error& e) {
    print_error(e.what(), e.hint);
    return e.code;
  } catch (const json::exception& e) {
    return print_version_mismatch(e);
  } catch (const std::invalid_argument& e) {
    // A word that this version does not know.
    return print_version_mismatch(e);
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return exit_refused;
  }
}

} // namespace

int run(int argc, char** argv) {
  return run(set_up, {argv + 1, argv + argc});
}

int run(const command_set& commands, std::vector<std::string> words) {
  CLI::App app;
  action chosen;
  commands(app, chosen);
  // The parser takes them from the end.
  std::reverse(words.begin(), words.end());
  try {
    app.parse(std::move(words));
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    const auto why = usage_error(app, e);
    print_error(why.what(), why.hint);
    return why.code;
  }
  return perform(chosen);
}

} // namespace roscell::cli
