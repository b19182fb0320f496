// Start-up of the core and the FIFO memory (RM0090, "OTG_FS programming model").
#include <board/board.hpp>
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/drivers/otg_fs/otg_fs.hpp"
#include "firmware/drivers/peripheral_clocks.hpp"
#include "firmware/drivers/pins.hpp"
#include "firmware/registers/peripherals.hpp"

#include "firmware/drivers/otg_fs/core.hpp"
#include "firmware/drivers/otg_fs/fifo_memory.hpp"

namespace inkwell::drivers {

namespace {

/// Turnaround time for an AHB clock of 32 MHz or more (RM0090, "TRDT values").
constexpr std::uint32_t turnaround_clocks = 6;
static_assert(board::processor_Hz >= 32'000'000);

/// Duration of the mode change: 25 ms (RM0090, GUSBCFG: FDMOD), plus 1 ms for a fast crystal.
constexpr std::uint32_t mode_change_cycles = board::processor_Hz / 1000 * 26;

bool reset_core() {
  if (!wait_for(core_answer_cycles, [] { return Core::GRSTCTL::AHBIDL::is_set(); })) return false;
  Core::GRSTCTL::modify(Core::GRSTCTL::CSRST(1));
  if (!wait_for(core_answer_cycles, [] { return !Core::GRSTCTL::CSRST::is_set(); })) return false;
  // The PHY clock domain needs three PHY clocks (11 processor cycles) before the next access.
  wait(32);
  return wait_for(core_answer_cycles, [] { return Core::GRSTCTL::AHBIDL::is_set(); });
}

}  // namespace

bool OtgFs::start() {
  connect<OtgFs, board::facts.usb_minus>(Pull::none, Speed::high);
  connect<OtgFs, board::facts.usb_plus>(Pull::none, Speed::high);
  UsbSupply::start(Pull::none);
  start_clocks_of<OtgFs, registers::OTG_FS_GLOBAL, registers::TIM2>();
  frame_clock_.start();

  Core::GUSBCFG::modify(Core::GUSBCFG::PHYSEL(1));
  if (!reset_core()) return false;
  Core::GCCFG::write(Core::GCCFG::PWRDWN(1));
  Core::GUSBCFG::modify(Core::GUSBCFG::FDMOD(1), Core::GUSBCFG::TRDT(turnaround_clocks));
  wait(mode_change_cycles);

  // PA9 drives a bridge, so the core cannot sense VBUS and must assume that VBUS is present. The soft disconnect is set
  // first, because the core would otherwise pull up D+. The function follow_cable() clears the soft disconnect.
  Device::DCTL::modify(Device::DCTL::SDIS(1));
  Core::GCCFG::modify(Core::GCCFG::NOVBUSSENS(1));
  // The boot loader may have stopped the PHY clock, and a core reset does not restart this clock (RM0090, GRSTCTL:
  // CSRST).
  Power::PCGCCTL::write(0);
  set_address(0);
  fifo_memory::lay_out();
  fifo_memory::flush_transmit(fifo_memory::all_transmit_fifos);
  fifo_memory::flush_receive();
  return true;
}

namespace fifo_memory {

void lay_out() {
  Core::GRXFSIZ::write(Core::GRXFSIZ::RXFD(receive_words));
  Core::DIEPTXF0::write(Core::DIEPTXF0::TX0FSA(control_start), Core::DIEPTXF0::TX0FD(control_words));
  Core::DIEPTXF1::write(Core::DIEPTXF1::INEPTXSA(hid_start), Core::DIEPTXF1::INEPTXFD(hid_words));
  Core::DIEPTXF2::write(Core::DIEPTXF2::INEPTXSA(scope_start), Core::DIEPTXF2::INEPTXFD(scope_words));
  Core::DIEPTXF3::write(Core::DIEPTXF3::INEPTXSA(controller_start), Core::DIEPTXF3::INEPTXFD(controller_words));
}

void flush_transmit(std::uint32_t number) {
  Core::GRSTCTL::write(Core::GRSTCTL::TXFFLSH(1), Core::GRSTCTL::TXFNUM(number));
  static_cast<void>(wait_for(core_answer_cycles, [] { return !Core::GRSTCTL::TXFFLSH::is_set(); }));
}

void flush_receive() {
  Core::GRSTCTL::write(Core::GRSTCTL::RXFFLSH(1));
  static_cast<void>(wait_for(core_answer_cycles, [] { return !Core::GRSTCTL::RXFFLSH::is_set(); }));
}

}  // namespace fifo_memory

}  // namespace inkwell::drivers
