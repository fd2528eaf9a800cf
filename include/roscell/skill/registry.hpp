#pragma once

#include "roscell/skill/executor.hpp"
#include "roscell/skill/handlers.hpp"
#include "roscell/skill/parameter_view.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>

namespace roscell::engine {

using executor_factory =
    std::function<std::unique_ptr<executor>(const environment&)>;
using input_factory =
    std::function<std::unique_ptr<input_handler>(const stream_context&)>;
using output_factory =
    std::function<std::unique_ptr<output_handler>(const stream_context&)>;

using view_factory = std::function<std::unique_ptr<parameter_view>(
    const environment&, const say_function&, const request_function&)>;

/// What a skill's binary is able to run: executors by implementation model,
/// input and output handlers by protocol. Starts with the `file` protocol; a
/// library with another protocol offers a function that adds it here. It is
/// filled before `run` and not changed after.
class registry {
public:
  registry();

  /// Each of the three replaces an earlier entry of the same name.
  void add_executor(const std::string& model, executor_factory make);
  void add_input(const std::string& protocol, input_factory make);
  void add_output(const std::string& protocol, output_factory make);

  /// Shows parameters of skills whose step uses that protocol.
  void set_parameter_view(const std::string& protocol, view_factory make);

  /// Adds a class that is constructed from `const environment&`, or from
  /// nothing.
  template <class Executor>
  void add_executor(const std::string& model) {
    add_executor(model, [](const environment& env) {
      if constexpr (std::is_constructible_v<Executor, const environment&>)
        return std::unique_ptr<executor>{std::make_unique<Executor>(env)};
      else
        return std::unique_ptr<executor>{std::make_unique<Executor>()};
    });
  }

  /// Each of the three throws start_error, with the names that are known, when
  /// the wanted one is not.
  std::unique_ptr<executor> make_executor(const environment& env) const;
  std::unique_ptr<input_handler> make_input(const stream_context& input) const;
  std::unique_ptr<output_handler>
  make_output(const stream_context& output) const;

  /// Null for a skill without a parameter that can be changed, or whose step
  /// does not use the protocol.
  std::unique_ptr<parameter_view>
  make_parameter_view(const environment& env, const say_function& say,
                      const request_function& request) const;

  /// One line for people: models and protocols.
  std::string summary() const;

private:
  std::map<std::string, executor_factory> executors_;
  std::map<std::string, input_factory> inputs_;
  std::map<std::string, output_factory> outputs_;
  std::string view_protocol_;
  view_factory make_view_;
};

} // namespace roscell::engine
