// Processor side of the OTG_FS core: global and device registers, interrupts, pull-up.
#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"

#include <algorithm>
#include <string>

#include "boards/stm32f405/otg_fs/otg_fs_map.hpp"

namespace inkwell::virtual_board {

namespace {

constexpr Ticks millisecond = ticks_per_s / 1000;
/// RM0090, OTG_FS_GUSBCFG: FDMOD.
constexpr Ticks mode_change_duration = 25 * millisecond;
/// A host resets the device only after D+ has been high for 100 ms. Firmware must finish the USB settings before the
/// bus reset.
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

bool is_fifo(std::uint32_t offset) {
  return offset >= otg_fifo_base && offset < otg_fifo_base + OtgFsDevice::endpoint_count * otg_fifo_window_bytes;
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
  usb_configuration_ = otg.gusbcfg.reset_value;
  core_configuration_ = 0;
  reset_since_selection_ = false;
  core_id_ = otg.cid.reset_value;
  device_configuration_ = otg.dcfg.reset_value;
  power_control_ = 0;
  otg_interrupts_ = 0;
  suspended_ = false;
  reset_core();
}

// A core reset (CSRST) retains the settings that depend on the wiring: GUSBCFG, GCCFG, the speed in DCFG, and PCGCCTL.
void OtgFsDevice::reset_core() {
  scheduler_.cancel(end_of_periodic_frame_);
  cancel_commands();
  bus_configuration_ = latched_interrupts_ = interrupt_mask_ = 0;
  receive_size_ = otg.grxfsiz.reset_value;
  transmit_size_[0] = otg.dieptxf0.reset_value;
  for (unsigned i = 1; i < endpoint_count; ++i)
    transmit_size_[i] = otg.dieptxf.reset_value + (i - 1) * otg.dieptxf.ineptxfd.of(otg.dieptxf.reset_value);
  device_configuration_ =
      otg.dcfg.dspd.with(otg.dcfg.dspd.of(device_configuration_)) | (otg.dcfg.reset_value & ~otg.dcfg.dspd.mask());
  device_control_ = in_mask_ = out_mask_ = endpoint_mask_ = in_empty_mask_ = 0;
  bus_discharge_ = otg.dvbusdis.reset_value;
  bus_pulse_ = otg.dvbuspulse.reset_value;
  in_ = {};
  out_ = {};
  in_[0].control = out_[0].control = otg.doepctl.usbaep.mask();
  receive_.clear();
  for (WordFifo& fifo : transmit_) fifo.clear();
  receive_data_words_ = 0;
  writing_endpoint_.reset();
  layout_changed_ = true;
  global_in_nak_ = global_out_nak_requested_ = global_out_nak_effective_ = false;
  address_ = 0;
  control_transfer_open_ = setup_stage_open_ = setup_done_unpopped_ = setup_done_lost_ = false;
  setup_was_seen_ = false;
  receive_found_empty_at_ = 0;
  setup_packets_allowed_ = 0;
  update_pull_up();
  update_interrupt();
}

std::uint32_t OtgFsDevice::read(std::uint32_t offset, unsigned size_bytes) {
  writing_endpoint_.reset();
  const std::uint32_t aligned = offset & ~3u;
  if (size_bytes != 4) rules_.violate(Rule::usb_narrow_access);
  const std::uint32_t value = is_fifo(aligned) ? pop_receive_data() : read_register(aligned);
  return size_bytes == 4 ? value : (value >> (8 * (offset & 3))) & ((1u << (8 * size_bytes)) - 1);
}

void OtgFsDevice::write(std::uint32_t offset, std::uint32_t value, unsigned size_bytes) {
  const std::uint32_t aligned = offset & ~3u;
  if (size_bytes != 4) rules_.violate(Rule::usb_narrow_access);
  value <<= 8 * (offset & 3);
  if (!store_may_come(aligned, value)) return;
  if (is_fifo(aligned)) {
    push_transmit_data((aligned - otg_fifo_base) / otg_fifo_window_bytes, value);
    return;
  }
  writing_endpoint_.reset();
  const bool of_device = aligned >= otg_device_base && aligned < otg_power_base;
  if (of_device && otg.gusbcfg.fdmod.in(usb_configuration_) &&
      scheduler_.now() - device_forced_at_ < mode_change_duration)
    rules_.violate(Rule::usb_mode_wait);
  write_register(aligned, value);
  update_interrupt();
}

std::vector<RegisterMap> OtgFsDevice::register_maps(const std::string& name, std::uint32_t at) const {
  return {{name + "_GLOBAL", at, shown<otg_global>()},
          {name + "_DEVICE", at + otg_device_base, shown<otg_device>()},
          {name + "_PWRCLK", at + otg_power_base, shown<otg_power>()}};
}

std::uint32_t OtgFsDevice::read_register(std::uint32_t offset) {
  if (offset < otg_device_base) return read_global(offset);
  if (offset < otg_power_base) return read_device(offset - otg_device_base);
  if (offset == otg_power_base + otg.pcgcctl) return power_control_;
  return not_modelled(offset, false, 0);
}

std::uint32_t OtgFsDevice::read_global(std::uint32_t offset) {
  if (otg.dieptxf.covers(offset)) return transmit_size_[1 + otg.dieptxf.index(offset)];
  switch (offset) {
    case otg.gotgctl: return otg.gotgctl.cidsts.mask() | (has_session() ? otg.gotgctl.bsvld.mask() : 0);
    case otg.gotgint: return otg_interrupts_;
    case otg.gahbcfg: return bus_configuration_;
    case otg.gusbcfg: return usb_configuration_;
    case otg.grstctl: return reset_control();
    case otg.gintsts: note_receive_fifo_check(); return interrupt_status();
    case otg.gintmsk: return interrupt_mask_;
    case otg.grxstsr: note_receive_fifo_check(); return receive_.empty() ? 0 : receive_.front();
    case otg.grxstsp: return pop_receive_status();
    case otg.grxfsiz: return receive_size_;
    case otg.dieptxf0: return transmit_size_[0];
    case otg.gccfg: return core_configuration_;
    case otg.cid: return core_id_;
    case otg_synthesis.gsnpsid: return otg_synthesis.gsnpsid.reset_value;
    case otg_synthesis.ghwcfg1: return otg_synthesis.ghwcfg1.reset_value;
    case otg_synthesis.ghwcfg2: return otg_synthesis.ghwcfg2.reset_value;
    case otg_synthesis.ghwcfg3: return otg_synthesis.ghwcfg3.reset_value;
    case otg_synthesis.ghwcfg4: return otg_synthesis.ghwcfg4.reset_value;
    default: return not_modelled(offset, false, 0);
  }
}

std::uint32_t OtgFsDevice::read_device(std::uint32_t offset) {
  if (offset >= otg.doepctl) return read_out_endpoint(offset);
  if (offset >= otg.diepctl) return read_in_endpoint(offset);
  switch (offset) {
    case otg.dcfg: return device_configuration_;
    case otg.dctl:
      return device_control_ | otg.dctl.ginsts.with(global_in_nak_) | otg.dctl.gonsts.with(global_out_nak_effective_);
    case otg.dsts:
      return otg.dsts.suspsts.with(suspended_) | otg.dsts.enumspd.with(otg_full_speed) |
             otg.dsts.fnsof.with(frame_number_);
    case otg.diepmsk: return in_mask_;
    case otg.doepmsk: return out_mask_;
    case otg.daint: return endpoint_interrupts();
    case otg.daintmsk: return endpoint_mask_;
    case otg.dvbusdis: return bus_discharge_;
    case otg.dvbuspulse: return bus_pulse_;
    case otg.diepempmsk: return in_empty_mask_;
    default: return not_modelled(otg_device_base + offset, false, 0);
  }
}

void OtgFsDevice::write_register(std::uint32_t offset, std::uint32_t value) {
  if (offset < otg_device_base)
    write_global(offset, value);
  else if (offset < otg_power_base)
    write_device(offset - otg_device_base, value);
  else if (offset == otg_power_base + otg.pcgcctl)
    power_control_ = value & writable(otg.pcgcctl);
  else
    not_modelled(offset, true, value);
}

void OtgFsDevice::write_global(std::uint32_t offset, std::uint32_t value) {
  if (otg.dieptxf.covers(offset)) {
    transmit_size_[1 + otg.dieptxf.index(offset)] = value;
    layout_changed_ = true;
    return;
  }
  switch (offset) {
    case otg.gotgctl: break;  // session request and host negotiation: the device is always the B device
    case otg.gotgint: otg_interrupts_ &= ~(value & bits_of(otg.gotgint, Access::rc_w1)); break;
    case otg.gahbcfg: bus_configuration_ = value & writable(otg.gahbcfg); break;
    case otg.gusbcfg:
      if (otg.gusbcfg.fhmod.in(value)) note("host mode is not modeled", offset, true, value);
      write_usb_configuration(value);
      break;
    case otg.grstctl: write_reset_control(value); break;
    case otg.gintsts: latched_interrupts_ &= ~(value & bits_of(otg.gintsts, Access::rc_w1)); break;
    case otg.gintmsk: interrupt_mask_ = value; break;
    case otg.grxfsiz:
      receive_size_ = value & writable(otg.grxfsiz);
      layout_changed_ = true;
      break;
    case otg.dieptxf0:
      transmit_size_[0] = value;
      layout_changed_ = true;
      break;
    case otg.gccfg:
      core_configuration_ = value & writable(otg.gccfg);
      update_pull_up();
      break;
    case otg.cid: core_id_ = value; break;
    default: not_modelled(offset, true, value); break;
  }
}

void OtgFsDevice::write_device(std::uint32_t offset, std::uint32_t value) {
  if (offset >= otg.doepctl) {
    write_out_endpoint(offset, value);
    return;
  }
  if (offset >= otg.diepctl) {
    write_in_endpoint(offset, value);
    return;
  }
  switch (offset) {
    case otg.dcfg: write_device_configuration(value); break;
    case otg.dctl: write_device_control(value); break;
    case otg.diepmsk: in_mask_ = value; break;
    case otg.doepmsk: out_mask_ = value; break;
    case otg.daintmsk: endpoint_mask_ = value; break;
    case otg.dvbusdis: bus_discharge_ = value & writable(otg.dvbusdis); break;
    case otg.dvbuspulse: bus_pulse_ = value & writable(otg.dvbuspulse); break;
    case otg.diepempmsk: in_empty_mask_ = value & writable(otg.diepempmsk); break;
    default: not_modelled(otg_device_base + offset, true, value); break;
  }
}

// A new device address applies after the status stage of SET_ADDRESS. The manual requires the firmware to write the
// address before the status stage.
void OtgFsDevice::write_device_configuration(std::uint32_t value) {
  device_configuration_ = (device_configuration_ & ~writable(otg.dcfg)) | (value & writable(otg.dcfg));
  if (!control_transfer_open_) address_ = programmed_address();
}

void OtgFsDevice::write_device_control(std::uint32_t value) {
  if (otg.dctl.rwusig.in(value))  // the bus is suspended only while no program uses the device
    note("remote wake-up is not modeled", otg_device_base + otg.dctl, true, value);
  device_control_ = value & writable(otg.dctl);
  if (otg.dctl.cginak.in(value)) global_in_nak_ = false;
  if (otg.dctl.sginak.in(value)) global_in_nak_ = true;
  if (otg.dctl.cgonak.in(value)) global_out_nak_requested_ = global_out_nak_effective_ = false;
  if (otg.dctl.sgonak.in(value) && !global_out_nak_requested_) {
    global_out_nak_requested_ = true;
    push_status(0, PacketStatus::global_out_nak, 0, false);
  }
  update_pull_up();
}

unsigned OtgFsDevice::programmed_address() const { return otg.dcfg.dad.of(device_configuration_); }

bool OtgFsDevice::has_session() const {
  return otg.gccfg.novbussens.in(core_configuration_) || (bus_power_ && otg.gccfg.vbusbsen.in(core_configuration_));
}

void OtgFsDevice::update_pull_up() {
  const bool pulled_up = otg.gccfg.pwrdwn.in(core_configuration_) && has_session() &&
                         !otg.dctl.sdis.in(device_control_) && !otg.gusbcfg.fhmod.in(usb_configuration_);
  const bool rises = pulled_up && !pulled_up_;
  pulled_up_ = pulled_up;
  if (rises) {
    bus_is_silent_ = true;
    ++attachments_;
    check_bus_power();
    scheduler_.cancel(connection_check_);
    connection_check_ = scheduler_.at(scheduler_.now() + connection_settles, [this] { check_connection(); });
  }
}

void OtgFsDevice::write_usb_configuration(std::uint32_t value) {
  const std::uint32_t risen = value & ~usb_configuration_;
  usb_configuration_ = value;
  if (otg.gusbcfg.physel.in(risen)) reset_since_selection_ = false;
  if (otg.gusbcfg.fdmod.in(risen)) device_forced_at_ = scheduler_.now();
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

// Checks whether a host can detect the device.
void OtgFsDevice::check_connection() {
  if (!pulled_up_) return;
  if (!pins_connected()) rules_.violate(Rule::usb_pins);
  if (!clock_is_exact()) rules_.violate(Rule::usb_clock, std::to_string(chip_.usb_Hz()) + " Hz");
  constexpr unsigned otg_fs = 10;
  if (!otg.gusbcfg.fdmod.in(usb_configuration_) && !chip_.has_function('A', 10, otg_fs)) rules_.violate(Rule::usb_mode);
}

// Checks whether the settings allow transfers.
void OtgFsDevice::check_core() {
  if (!otg.gusbcfg.physel.in(usb_configuration_))
    rules_.violate(Rule::usb_transceiver);
  else if (!reset_since_selection_)
    rules_.violate(Rule::usb_core_reset);
  if (otg.dcfg.dspd.of(device_configuration_) != otg_full_speed) rules_.violate(Rule::usb_speed);
}

// TRDT is checked at each answered packet, because the firmware may set TRDT after speed enumeration.
void OtgFsDevice::check_turnaround() {
  if (otg.gusbcfg.trdt.of(usb_configuration_) < turnaround_needed(chip_.hclk_Hz()))
    rules_.violate(Rule::usb_turnaround);
}

std::uint32_t OtgFsDevice::in_interrupts(unsigned endpoint) const {
  return in_[endpoint].interrupts | otg.diepint.txfe.with(transmit_empty_level(endpoint));
}

// DAINT. The TXFE interrupt has a separate mask register with one bit for each endpoint.
std::uint32_t OtgFsDevice::endpoint_interrupts() const {
  std::uint32_t active = 0;
  for (unsigned i = 0; i < endpoint_count; ++i) {
    const bool empty_wanted = (in_empty_mask_ & (1u << i)) != 0;
    if ((in_[i].interrupts & in_mask_ & ~otg.diepint.txfe.mask()) != 0 || (empty_wanted && transmit_empty_level(i)))
      active |= 1u << i;
    if ((out_[i].interrupts & out_mask_) != 0) active |= otg.daint.oepint.with(1u << i);
  }
  return active;
}

std::uint32_t OtgFsDevice::interrupt_status() const {
  const auto& flags = otg.gintsts;
  const std::uint32_t endpoints = endpoint_interrupts() & endpoint_mask_;
  const std::uint32_t host_side = flags.ptxfe.mask();  // idle in device mode, with its reset value
  return latched_interrupts_ | host_side | flags.otgint.with(otg_interrupts_ != 0) |
         flags.rxflvl.with(!receive_.empty()) | flags.nptxfe.with(transmit_empty_level(0)) |
         flags.ginakeff.with(global_in_nak_) | flags.goutnakeff.with(global_out_nak_effective_) |
         flags.iepint.with(otg.daint.iepint.in(endpoints)) | flags.oepint.with(otg.daint.oepint.in(endpoints));
}

bool OtgFsDevice::reset_is_unseen() const { return otg.gintsts.usbrst.in(latched_interrupts_); }

void OtgFsDevice::update_interrupt() {
  const bool asserted = otg.gahbcfg.gint.in(bus_configuration_) && (interrupt_status() & interrupt_mask_) != 0;
  if (asserted == interrupt_asserted_) return;
  interrupt_asserted_ = asserted;
  interrupts_.set_level(otg_fs_position, asserted);
}

std::uint32_t OtgFsDevice::not_modelled(std::uint32_t offset, bool is_write, std::uint32_t value) {
  log_.note("OTG_FS", offset, is_write, value);
  return 0;
}

void OtgFsDevice::note(const char* sentence, std::uint32_t offset, bool is_write, std::uint32_t value) {
  log_.note(std::string("OTG_FS: ") + sentence, offset, is_write, value);
}

}  // namespace inkwell::virtual_board
