// The OTG_FS core towards the processor: global and device registers, interrupts, pull-up.
#include <virtual_usb/otg_fs_device.hpp>

#include <algorithm>
#include <string>

#include "otg_fs_registers.hpp"

namespace inkwell::virtual_board {

using namespace otg;

namespace {

constexpr Ticks millisecond = ticks_per_s / 1000;
/// RM0090, OTG_FS_GUSBCFG: FDMOD.
constexpr Ticks mode_change_duration = 25 * millisecond;
/// A host looks for a reset only when D+ has been up for 100 ms; a driver is done with its settings before.
constexpr Ticks connection_settles = 50 * millisecond;

/// RM0090, table "TRDT values".
unsigned turnaround_needed(std::uint32_t hclk_Hz) {
  constexpr std::uint32_t from_kHz[] = {32'000, 27'500, 24'000, 21'800, 20'000, 18'500, 17'200, 16'000, 15'000};
  unsigned clocks = 6;
  for (const std::uint32_t limit_kHz : from_kHz) {
    if (hclk_Hz >= 1000 * limit_kHz) break;
    ++clocks;
  }
  return clocks;
}

}  // namespace

OtgFsDevice::OtgFsDevice(const ChipConnections& chip)
    : scheduler_(chip.scheduler),
      interrupts_(chip.interrupts),
      log_(chip.log),
      rules_(chip.rules),
      chip_(chip.state),
      triggers_(chip.triggers) {
  reset();
}

void OtgFsDevice::reset() {
  usb_configuration_ = reset_value::gusbcfg;
  core_configuration_ = 0;
  reset_since_selection_ = false;
  core_id_ = reset_value::cid;
  device_configuration_ = reset_value::dcfg;
  power_control_ = 0;
  otg_interrupts_ = 0;
  suspended_ = false;
  reset_core();
}

// CSRST. What describes the wiring (GUSBCFG, GCCFG, the speed in DCFG, PCGCCTL) survives it.
void OtgFsDevice::reset_core() {
  scheduler_.cancel(end_of_periodic_frame_);
  bus_configuration_ = latched_interrupts_ = interrupt_mask_ = 0;
  receive_size_ = reset_value::grxfsiz;
  transmit_size_[0] = reset_value::dieptxf0;
  for (unsigned i = 1; i < endpoint_count; ++i)
    transmit_size_[i] = reset_value::dieptxf_first + (i - 1) * (reset_value::dieptxf_first >> 16);
  device_configuration_ = (device_configuration_ & dcfg::dspd) | (reset_value::dcfg & ~dcfg::dspd);
  device_control_ = in_mask_ = out_mask_ = endpoint_mask_ = in_empty_mask_ = 0;
  bus_discharge_ = reset_value::dvbusdis;
  bus_pulse_ = reset_value::dvbuspulse;
  in_ = {};
  out_ = {};
  in_[0].control = out_[0].control = epctl::usbaep;
  receive_.clear();
  for (WordFifo& fifo : transmit_) fifo.clear();
  receive_data_words_ = 0;
  writing_endpoint_.reset();
  layout_changed_ = true;
  global_in_nak_ = global_out_nak_asked_ = global_out_nak_effective_ = false;
  address_ = 0;
  control_transfer_open_ = setup_stage_open_ = setup_done_unpopped_ = setup_done_lost_ = false;
  setup_packets_allowed_ = 0;
  update_pull_up();
  update_interrupt();
}

std::uint32_t OtgFsDevice::read(std::uint32_t offset, unsigned size_bytes) {
  writing_endpoint_.reset();
  const std::uint32_t aligned = offset & ~3u;
  if (size_bytes != 4) rules_.violate(Rule::usb_narrow_access);
  std::uint32_t value = 0;
  if (aligned >= offset::fifos && aligned < offset::fifos + endpoint_count * offset::fifo_window_bytes)
    value = pop_receive_data();
  else
    value = read_register(aligned);
  return size_bytes == 4 ? value : (value >> (8 * (offset & 3))) & ((1u << (8 * size_bytes)) - 1);
}

void OtgFsDevice::write(std::uint32_t offset, std::uint32_t value, unsigned size_bytes) {
  const std::uint32_t aligned = offset & ~3u;
  if (size_bytes != 4) rules_.violate(Rule::usb_narrow_access);
  value <<= 8 * (offset & 3);
  if (aligned >= offset::fifos && aligned < offset::fifos + endpoint_count * offset::fifo_window_bytes) {
    push_transmit_data((aligned - offset::fifos) / offset::fifo_window_bytes, value);
    return;
  }
  writing_endpoint_.reset();
  const bool of_device = aligned >= offset::dcfg && aligned < offset::pcgcctl;
  if (of_device && (usb_configuration_ & gusbcfg::fdmod) != 0 &&
      scheduler_.now() - device_forced_at_ < mode_change_duration)
    rules_.violate(Rule::usb_mode_wait);
  write_register(aligned, value);
  update_interrupt();
}

std::uint32_t OtgFsDevice::read_register(std::uint32_t offset) {
  if (offset >= offset::in_endpoints && offset < offset::in_endpoints + endpoint_count * offset::endpoint_bytes)
    return read_in_endpoint(offset - offset::in_endpoints);
  if (offset >= offset::out_endpoints && offset < offset::out_endpoints + endpoint_count * offset::endpoint_bytes)
    return read_out_endpoint(offset - offset::out_endpoints);
  if (offset >= offset::dieptxf1 && offset <= offset::dieptxf3)
    return transmit_size_[1 + (offset - offset::dieptxf1) / 4];
  switch (offset) {
    case offset::gotgctl: {
      const bool session = (core_configuration_ & gccfg::novbussens) != 0 ||
                           (bus_power_ && (core_configuration_ & gccfg::vbusbsen) != 0);
      return gotgctl::cidsts | (session ? gotgctl::bsvld : 0);
    }
    case offset::gotgint: return otg_interrupts_;
    case offset::gahbcfg: return bus_configuration_;
    case offset::gusbcfg: return usb_configuration_;
    case offset::grstctl: return grstctl::ahbidl;
    case offset::gintsts: return interrupt_status();
    case offset::gintmsk: return interrupt_mask_;
    case offset::grxstsr: return receive_.empty() ? 0 : receive_.front();
    case offset::grxstsp: return pop_receive_status();
    case offset::grxfsiz: return receive_size_;
    case offset::dieptxf0: return transmit_size_[0];
    case offset::gccfg: return core_configuration_;
    case offset::cid: return core_id_;
    case offset::gsnpsid: return reset_value::gsnpsid;
    case offset::ghwcfg1: return 0;
    case offset::ghwcfg2: return reset_value::ghwcfg2;
    case offset::ghwcfg3: return reset_value::ghwcfg3;
    case offset::ghwcfg4: return reset_value::ghwcfg4;
    case offset::dcfg: return device_configuration_;
    case offset::dctl:
      return device_control_ | (global_in_nak_ ? dctl::ginsts : 0) | (global_out_nak_effective_ ? dctl::gonsts : 0);
    case offset::dsts: return (suspended_ ? dsts::suspsts : 0) | dsts::full_speed | (std::uint32_t{frame_number_} << 8);
    case offset::diepmsk: return in_mask_;
    case offset::doepmsk: return out_mask_;
    case offset::daint: return endpoint_interrupts();
    case offset::daintmsk: return endpoint_mask_;
    case offset::dvbusdis: return bus_discharge_;
    case offset::dvbuspulse: return bus_pulse_;
    case offset::diepempmsk: return in_empty_mask_;
    case offset::pcgcctl: return power_control_;
    default: log_.note("OTG_FS", offset, false, 0); return 0;
  }
}

void OtgFsDevice::write_register(std::uint32_t offset, std::uint32_t value) {
  if (offset >= offset::in_endpoints && offset < offset::in_endpoints + endpoint_count * offset::endpoint_bytes) {
    write_in_endpoint(offset - offset::in_endpoints, value);
    return;
  }
  if (offset >= offset::out_endpoints && offset < offset::out_endpoints + endpoint_count * offset::endpoint_bytes) {
    write_out_endpoint(offset - offset::out_endpoints, value);
    return;
  }
  if (offset >= offset::dieptxf1 && offset <= offset::dieptxf3) {
    transmit_size_[1 + (offset - offset::dieptxf1) / 4] = value;
    layout_changed_ = true;
    return;
  }
  switch (offset) {
    case offset::gotgctl: break;  // session request and host negotiation: the device is always the B side
    case offset::gotgint: otg_interrupts_ &= ~(value & gotgint::writable); break;
    case offset::gahbcfg: bus_configuration_ = value & gahbcfg::writable; break;
    case offset::gusbcfg:
      if ((value & gusbcfg::fhmod) != 0) note("host mode is not modelled", offset, true, value);
      write_usb_configuration(value);
      break;
    case offset::grstctl: write_reset_control(value); break;
    case offset::gintsts: latched_interrupts_ &= ~(value & gint::cleared_by_one); break;
    case offset::gintmsk: interrupt_mask_ = value; break;
    case offset::grxfsiz:
      receive_size_ = value & 0xFFFF;
      layout_changed_ = true;
      break;
    case offset::dieptxf0:
      transmit_size_[0] = value;
      layout_changed_ = true;
      break;
    case offset::gccfg:
      core_configuration_ = value & gccfg::writable;
      update_pull_up();
      break;
    case offset::cid: core_id_ = value; break;
    case offset::dcfg: write_device_configuration(value); break;
    case offset::dctl: write_device_control(value); break;
    case offset::diepmsk: in_mask_ = value; break;
    case offset::doepmsk: out_mask_ = value; break;
    case offset::daintmsk: endpoint_mask_ = value; break;
    case offset::dvbusdis: bus_discharge_ = value & 0xFFFF; break;
    case offset::dvbuspulse: bus_pulse_ = value & 0xFFF; break;
    case offset::diepempmsk: in_empty_mask_ = value & 0xFFFF; break;
    case offset::pcgcctl: power_control_ = value & 0x13; break;
    default: log_.note("OTG_FS", offset, true, value); break;
  }
}

void OtgFsDevice::write_reset_control(std::uint32_t value) {
  if ((value & grstctl::csrst) != 0) {
    reset_since_selection_ = (usb_configuration_ & gusbcfg::physel) != 0;
    reset_core();
    return;
  }
  if ((value & grstctl::rxfflsh) != 0) {
    receive_.clear();
    receive_data_words_ = 0;
    setup_stage_open_ = setup_done_unpopped_ = setup_done_lost_ = false;
  }
  if ((value & grstctl::txfflsh) != 0) {
    const unsigned number = grstctl::txfnum(value);
    if (number == grstctl::all_fifos)
      for (unsigned i = 0; i < endpoint_count; ++i) flush_transmit(i);
    else if (number < endpoint_count)
      flush_transmit(number);
    else
      rules_.violate(Rule::usb_no_such_fifo);
  }
}

// A new address is for the transactions after the status stage of the request that brought it: the manual
// has firmware write it before that stage.
void OtgFsDevice::write_device_configuration(std::uint32_t value) {
  device_configuration_ = (device_configuration_ & ~dcfg::writable) | (value & dcfg::writable);
  if (!control_transfer_open_) address_ = programmed_address();
}

void OtgFsDevice::write_device_control(std::uint32_t value) {
  if ((value & dctl::rwusig) != 0)  // the bus sleeps only while nobody uses the device, so nobody could wake
    note("remote wake-up is not modelled", offset::dctl, true, value);
  device_control_ = value & dctl::writable;
  if ((value & dctl::cginak) != 0) global_in_nak_ = false;
  if ((value & dctl::sginak) != 0) global_in_nak_ = true;
  if ((value & dctl::cgonak) != 0) global_out_nak_asked_ = global_out_nak_effective_ = false;
  if ((value & dctl::sgonak) != 0 && !global_out_nak_asked_) {
    global_out_nak_asked_ = true;
    push_status(0, pktsts::global_out_nak, 0, false);
  }
  update_pull_up();
}

unsigned OtgFsDevice::programmed_address() const { return dcfg::dad(device_configuration_); }

void OtgFsDevice::update_pull_up() {
  const bool session =
      (core_configuration_ & gccfg::novbussens) != 0 || (bus_power_ && (core_configuration_ & gccfg::vbusbsen) != 0);
  const bool pulled_up = (core_configuration_ & gccfg::pwrdwn) != 0 && session && (device_control_ & dctl::sdis) == 0 &&
                         (usb_configuration_ & gusbcfg::fhmod) == 0;
  if (pulled_up && !pulled_up_) {
    ++attachments_;
    scheduler_.cancel(connection_check_);
    connection_check_ = scheduler_.at(scheduler_.now() + connection_settles, [this] { check_connection(); });
  }
  pulled_up_ = pulled_up;
}

void OtgFsDevice::write_usb_configuration(std::uint32_t value) {
  const std::uint32_t risen = value & ~usb_configuration_;
  usb_configuration_ = value;
  if ((risen & gusbcfg::physel) != 0) reset_since_selection_ = false;
  if ((risen & gusbcfg::fdmod) != 0) device_forced_at_ = scheduler_.now();
  update_pull_up();
}

bool OtgFsDevice::pins_connected() const {
  constexpr unsigned otg_fs = 10;
  return chip_.has_function('A', 11, otg_fs) && chip_.has_function('A', 12, otg_fs);
}

bool OtgFsDevice::clock_is_exact() const {
  constexpr std::uint32_t nominal_Hz = 48'000'000, tolerance_Hz = nominal_Hz / 400;
  return chip_.usb_Hz() >= nominal_Hz - tolerance_Hz && chip_.usb_Hz() <= nominal_Hz + tolerance_Hz;
}

// What the host needs to see a device at all.
void OtgFsDevice::check_connection() {
  if (!pulled_up_) return;
  if (!pins_connected()) rules_.violate(Rule::usb_pins);
  if (!clock_is_exact()) rules_.violate(Rule::usb_clock, std::to_string(chip_.usb_Hz()) + " Hz");
  constexpr unsigned otg_fs = 10;
  if ((usb_configuration_ & gusbcfg::fdmod) == 0 && !chip_.has_function('A', 10, otg_fs))
    rules_.violate(Rule::usb_mode);
}

// What must be in place when the host has reset the bus and transfers may begin.
void OtgFsDevice::check_core() {
  if ((usb_configuration_ & gusbcfg::physel) == 0)
    rules_.violate(Rule::usb_transceiver);
  else if (!reset_since_selection_)
    rules_.violate(Rule::usb_core_reset);
  if ((device_configuration_ & dcfg::dspd) != dcfg::full_speed) rules_.violate(Rule::usb_speed);
  if (gusbcfg::trdt(usb_configuration_) < turnaround_needed(chip_.hclk_Hz())) rules_.violate(Rule::usb_turnaround);
}

std::uint32_t OtgFsDevice::in_interrupts(unsigned endpoint) const {
  return in_[endpoint].interrupts | (transmit_empty_level(endpoint) ? epint::txfe : 0);
}

// DAINT: TXFE has its own mask, one bit for each endpoint.
std::uint32_t OtgFsDevice::endpoint_interrupts() const {
  std::uint32_t active = 0;
  for (unsigned i = 0; i < endpoint_count; ++i) {
    const bool empty_wanted = (in_empty_mask_ & (1u << i)) != 0;
    if ((in_[i].interrupts & in_mask_ & ~epint::txfe) != 0 || (empty_wanted && transmit_empty_level(i)))
      active |= 1u << i;
    if ((out_[i].interrupts & out_mask_) != 0) active |= 1u << (16 + i);
  }
  return active;
}

std::uint32_t OtgFsDevice::interrupt_status() const {
  constexpr std::uint32_t host_transmit_fifo_empty = 1u << 26;  // idle in device mode: reads as after reset
  const std::uint32_t endpoints = endpoint_interrupts() & endpoint_mask_;
  return latched_interrupts_ | host_transmit_fifo_empty | (otg_interrupts_ != 0 ? gint::otgint : 0) |
         (receive_.empty() ? 0 : gint::rxflvl) | (transmit_empty_level(0) ? gint::nptxfe : 0) |
         (global_in_nak_ ? gint::ginakeff : 0) | (global_out_nak_effective_ ? gint::gonakeff : 0) |
         ((endpoints & 0xFFFF) != 0 ? gint::iepint : 0) | ((endpoints >> 16) != 0 ? gint::oepint : 0);
}

bool OtgFsDevice::reset_is_unseen() const { return (latched_interrupts_ & gint::usbrst) != 0; }

void OtgFsDevice::update_interrupt() {
  const bool asserted = (bus_configuration_ & gahbcfg::gint) != 0 && (interrupt_status() & interrupt_mask_) != 0;
  if (asserted == interrupt_asserted_) return;
  interrupt_asserted_ = asserted;
  interrupts_.set_level(interrupt_position, asserted);
}

void OtgFsDevice::note(const char* sentence, std::uint32_t offset, bool is_write, std::uint32_t value) {
  log_.note(std::string("OTG_FS: ") + sentence, offset, is_write, value);
}

}  // namespace inkwell::virtual_board
