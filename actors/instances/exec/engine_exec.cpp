#include "actors/instances/exec/engine_exec.hpp"

#include "actors/edge/exec/engine_channel.hpp"
#include "actors/instances/engine/container_document.hpp"
#include "actors/instances/engine/engine_runtime.hpp"
#include "actors/instances/exec/process_exec.hpp"

#include <utility>
#include <vector>

namespace roscell {

namespace {

/// As short as that of the NOTIFY_SOCKET beside it: the path of a Unix socket
/// is bounded.
std::string lifeline_name(const exec_order& order) {
  constexpr size_t digits = 5;
  return "x" + order.session.substr(0, digits);
}

std::vector<std::string> settings_for(const exec_order& order) {
  // A command is no skill: what it says there would be taken for the skill's.
  std::vector<std::string> result{"NOTIFY_SOCKET=",
                                  exec_variable + ("=" + order.session)};
  if (order.terminal)
    result.push_back(std::string{"TERM="} + exec_terminal);
  return result;
}

/// The container's shim runs it, as who the program of the instance is.
std::vector<std::string> words_in(const std::vector<std::string>& entry,
                                  const exec_order& order) {
  auto result = beside(entry, order);
  result.insert(result.begin(), {shim_inside, "--lifeline",
                                 std::string{container_notify_dir} + '/'
                                     + lifeline_name(order)});
  return result;
}

} // namespace

exec_opener engine_opener(std::shared_ptr<io_core> core, std::string socket,
                          std::string api, std::filesystem::path data_dir) {
  return [=](const exec_order& order, exec_callbacks calls)
             -> edge_result<std::shared_ptr<exec_channel>> {
    const auto folder =
        container_notify_path(data_dir, order.instance).parent_path();
    auto lifeline = lifeline_socket::open(folder / lifeline_name(order));
    if (const auto* why = std::get_if<edge_error>(&lifeline))
      return *why;
    return open_engine_channel(
        core,
        {socket, api, order,
         [order](const auto& entry) { return words_in(entry, order); },
         settings_for(order), std::move(std::get<lifeline_socket>(lifeline))},
        std::move(calls));
  };
}

} // namespace roscell
