#include "tools/roscell/commands/watch.hpp"

#include "tools/roscell/client/change_signal.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <string>
#include <utility>

namespace roscell::cli {

namespace {

/// The drawing of one document.
class screen {
public:
  screen(bool as_json, const std::function<std::string(const json&)>& view)
      : as_json_{as_json}, view_{view} {}

  void show(const json& document) {
    auto text = as_json_ ? compact(document) : view_(document);
    if (text == last_)
      return;
    last_ = std::move(text);
    // Home and clear below: unlike a cleared screen this does not flicker.
    const bool redrawn = !as_json_ && stdout_is_terminal();
    print((redrawn ? "\x1b[H\x1b[J" : "") + last_);
    if (!as_json_ && !redrawn)
      print("\n");
  }

private:
  bool as_json_;
  const std::function<std::string(const json&)>& view_;
  std::string last_;
};

} // namespace

int watch(const node_client& node, bool as_json,
          const std::function<json()>& fetch,
          const std::function<std::string(const json&)>& view) {
  end_quietly_on_interrupt();
  change_signal changes{node};
  screen output{as_json, view};
  while (true) {
    output.show(fetch());
    changes.wait();
  }
}

} // namespace roscell::cli
