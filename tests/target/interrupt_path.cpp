// What the control interrupt calls of the signal path, so that its machine code can be looked through.
#include <control/controller.hpp>

namespace {

struct CycleClock {
  std::uint32_t lap() const { return *reinterpret_cast<const volatile std::uint32_t*>(0xE0001004); }  // DWT_CYCCNT
};

}  // namespace

extern "C" inkwell::control::Drive control_interrupt(inkwell::control::Controller& controller,
                                                     const inkwell::control::Samples& samples,
                                                     const inkwell::control::Settings& settings,
                                                     const inkwell::protocol::CommandReport& command) {
  CycleClock clock;
  controller.carry_out(command);
  controller.host_alive();
  controller.raise(inkwell::protocol::Fault::servo_overrun);
  const inkwell::control::Drive drive = controller.step(samples, settings, clock);
  controller.finish(clock);
  return drive;
}
