#include "actors/instances/exec/process_exec.hpp"

#include "actors/edge/exec/attached_program.hpp"
#include "actors/edge/exec/child_channel.hpp"
#include "actors/edge/process/process_identity.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

/// What a command has from the shim of its instance; the rest is about records.
constexpr std::array<std::string_view, 5> shared_options{
    "--cwd", "--cgroup", "--scheduling", "--user", "--capabilities"};

/// A command is no skill: what it says there would be taken for the skill's.
constexpr const char* socket_variable = "NOTIFY_SOCKET";

edge_error not_running(const exec_order& order) {
  return {error_code::conflict,
          "instance '" + order.instance + "' does not run any more",
          "`roscell instances` shows which ones run"};
}

/// The texts in a file of proc(5), each with a zero behind it.
std::vector<std::string> texts_in(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  const std::string all{std::istreambuf_iterator<char>{file}, {}};
  std::vector<std::string> result;
  for (size_t at = 0; at < all.size();) {
    const auto end = std::min(all.find('\0', at), all.size());
    result.push_back(all.substr(at, end - at));
    at = end + 1;
  }
  return result;
}

/// Who the program of an instance is, where it is another user than its node.
std::optional<uid_t> user_in(const std::vector<std::string>& words) {
  const auto end = std::find(words.begin(), words.end(), "--");
  const auto option = std::find(words.begin(), end, "--user");
  if (option == end || option + 1 == end)
    return std::nullopt;
  const auto& text = *(option + 1);
  uid_t result = 0;
  const auto read =
      std::from_chars(text.data(), text.data() + text.size(), result);
  return read.ec == std::errc{} ? std::optional{result} : std::nullopt;
}

std::map<std::string, std::string>
environment_beside(const std::vector<std::string>& settings,
                   const exec_order& order) {
  std::map<std::string, std::string> result;
  for (const auto& x : settings)
    if (const auto equals = x.find('='); equals != std::string::npos)
      result[x.substr(0, equals)] = x.substr(equals + 1);
  result.erase(socket_variable);
  result[exec_variable] = order.session;
  if (order.terminal)
    result.emplace("TERM", exec_terminal);
  return result;
}

} // namespace

std::vector<std::string> beside(const std::vector<std::string>& words,
                                const exec_order& order) {
  std::vector<std::string> result{"--attached",
                                  order.terminal ? "terminal" : "pipes"};
  for (size_t i = 1; i + 1 < words.size() && words[i] != "--"; i += 2)
    if (std::find(shared_options.begin(), shared_options.end(), words[i])
        != shared_options.end())
      result.insert(result.end(), {words[i], words[i + 1]});
  result.push_back("--");
  result.insert(result.end(), order.command.begin(), order.command.end());
  return result;
}

exec_opener process_opener(std::shared_ptr<io_core> core,
                           std::filesystem::path shim) {
  return
      [core = std::move(core), shim = std::move(shim)](
          const exec_order& order,
          exec_callbacks calls) -> edge_result<std::shared_ptr<exec_channel>> {
        const auto identity = process_of(order.container);
        auto instance = identity ? open_process(*identity, '/' + order.instance)
                                 : unique_fd{};
        if (!instance || has_ended(instance.get()))
          return not_running(order);
        const auto proc = "/proc/" + std::to_string(identity->pid);
        const auto words = texts_in(proc + "/cmdline");
        const auto settings = texts_in(proc + "/environ");
        if (words.empty() || has_ended(instance.get()))
          return not_running(order);
        auto program = spawn_attached(
            {shim, beside(words, order), environment_beside(settings, order)},
            order.terminal ? std::optional{order.size} : std::nullopt,
            user_in(words));
        if (const auto* why = std::get_if<edge_error>(&program))
          return *why;
        return open_child_channel(
            core, std::move(std::get<attached_program>(program)),
            order.terminal, std::move(instance), std::move(calls));
      };
}

} // namespace roscell
