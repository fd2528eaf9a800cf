#include "roscell/skill.hpp"

/// The smallest skill: repeats each frame with a prefix.
class echo : public roscell::engine::executor {
public:
  explicit echo(const roscell::engine::environment& env)
      : prefix_(env.parameters.text("prefix", "")) {
    // nop
  }

  void process(const roscell::engine::frame& input,
               roscell::engine::emitter& output) override {
    output.emit(prefix_ + input.payload);
  }

  void on_parameters(const roscell::engine::parameters& now) override {
    prefix_ = now.text("prefix", "");
  }

  void release() override {
    // Nothing is held.
  }

private:
  std::string prefix_;
};

int main(int argc, char** argv) {
  return roscell::engine::run<echo>("plain", argc, argv);
}
