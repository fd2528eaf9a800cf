#include "roscell/skill/try_out.hpp"

#include "roscell/skill/stop_event.hpp"
#include "skills/engine/file/file_protocol.hpp"

#include <utility>

namespace roscell::engine {

namespace {

/// Keeps what is emitted.
class kept_results : public emitter {
public:
  std::vector<frame> results;

private:
  void write(frame result, std::size_t port) override {
    result.port = port;
    results.push_back(std::move(result));
  }
};

/// Gives each frame to the executor at once.
class direct_sink : public frame_sink {
public:
  direct_sink(executor& subject, const std::string& data_type, emitter& output)
      : subject_(subject), data_type_(data_type), output_(output) {
    // nop
  }

  bool push(frame input, when_full) override {
    input.data_type = data_type_;
    input.sequence = next_sequence_++;
    subject_.process(input, output_);
    return true;
  }

private:
  executor& subject_;
  const std::string& data_type_;
  emitter& output_;
  std::uint64_t next_sequence_ = 0;
};

} // namespace

std::vector<frame> try_out(executor& subject, const std::string& path,
                           const std::string& data_type) {
  const auto input = make_file_input({{"file", path, data_type},
                                      parameters::parse(R"({"follow": false})"),
                                      [](const std::string&) {}});
  kept_results output;
  direct_sink sink{subject, data_type, output};
  input->open();
  input->run(sink, stop_event{});
  subject.release();
  return std::move(output.results);
}

} // namespace roscell::engine
