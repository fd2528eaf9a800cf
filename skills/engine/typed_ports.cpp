#include "roscell/skill/typed_ports.hpp"

#include "roscell/skill/errors.hpp"

namespace roscell::engine {

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
