#include "roscell/skill/registry.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/typed_ports.hpp"
#include "skills/engine/file/file_protocol.hpp"

#include <algorithm>
#include <utility>

namespace roscell::engine {

namespace {

template <class Factory>
std::string names(const std::map<std::string, Factory>& factories) {
  std::string result;
  for (const auto& [name, make] : factories)
    result += (result.empty() ? "" : ", ") + name;
  return result.empty() ? "none" : result;
}

template <class Factory>
const Factory& find(const std::map<std::string, Factory>& factories,
                    const std::string& name, const std::string& what) {
  auto i = factories.find(name);
  if (i == factories.end())
    throw start_error("this skill has no " + what + " '" + name
                      + "', it knows: " + names(factories)
                      + "; correct the step or skill.json");
  return i->second;
}

} // namespace

registry::registry() {
  add_file_protocol(*this);
}

void registry::add_executor(const std::string& model, executor_factory make) {
  executors_[model] = std::move(make);
}

void registry::add_input(const std::string& protocol, input_factory make) {
  inputs_[protocol] = std::move(make);
}

void registry::add_output(const std::string& protocol, output_factory make) {
  outputs_[protocol] = std::move(make);
}

void registry::set_parameter_view(const std::string& protocol,
                                  view_factory make) {
  view_protocol_ = protocol;
  make_view_ = std::move(make);
}

std::unique_ptr<parameter_view>
registry::make_parameter_view(const environment& env, const say_function& say,
                              const request_function& request) const {
  const auto uses_it = [this](const stream& x) {
    return x.protocol == view_protocol_;
  };
  if (!make_view_ || env.changeable.empty()
      || (std::none_of(env.inputs.begin(), env.inputs.end(), uses_it)
          && std::none_of(env.outputs.begin(), env.outputs.end(), uses_it)))
    return nullptr;
  return make_view_(env, say, request);
}

std::unique_ptr<executor>
registry::make_executor(const environment& env) const {
  return find(executors_, env.model, "model")(env);
}

std::unique_ptr<input_handler>
registry::make_input(const stream_context& input) const {
  return find(inputs_, input.config.protocol, "input protocol")(input);
}

std::unique_ptr<output_handler>
registry::make_output(const stream_context& output) const {
  return find(outputs_, output.config.protocol, "output protocol")(output);
}

std::string registry::summary() const {
  return "models: " + names(executors_) + "; input protocols: " + names(inputs_)
         + "; output protocols: " + names(outputs_);
}

std::vector<std::size_t> ports_of_type(const std::vector<stream>& streams,
                                       const std::string& data_type) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < streams.size(); ++i)
    if (streams[i].data_type == data_type)
      result.push_back(i);
  return result;
}

typed_outputs::typed_outputs(const std::vector<stream>& outputs,
                             const std::string& data_type, std::size_t sources)
    : ports_(ports_of_type(outputs, data_type)) {
  if (ports_.size() > 1 && ports_.size() != sources)
    throw start_error("the step has " + std::to_string(ports_.size())
                      + " outputs of type '" + data_type + "' for "
                      + std::to_string(sources)
                      + " image inputs; give one for each input, or one for "
                        "all");
}

std::size_t typed_outputs::of_source(std::size_t k) const {
  if (ports_.empty())
    return none;
  return ports_.size() == 1 ? ports_.front() : ports_.at(k);
}

} // namespace roscell::engine
