// Delayed commands of the OTG_FS core: reset, flush, NAK and endpoint disable.
#include <algorithm>
#include <string>

#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"

#include "boards/stm32f405/otg_fs/otg_fs_map.hpp"

namespace inkwell::virtual_board {

namespace {

constexpr Ticks transceiver_clock = ticks_per_s / 48'000'000;
/// A FIFO flush lasts eight PHY clock cycles (RM0090, OTG_FS reset register).
constexpr Ticks command_duration = 8 * transceiver_clock;
/// The manual states no duration for a core reset, but requires the firmware to poll CSRST.
constexpr Ticks core_reset_duration = ticks_per_s / 1'000'000;
/// Minimum time from the core reset to the first access to the PHY clock domain.
constexpr Ticks rest_after_reset = 3 * transceiver_clock;

bool is_fifo_of(std::uint32_t offset, unsigned endpoint) {
  return offset >= otg_fifo_base && (offset - otg_fifo_base) / otg_fifo_window_bytes == endpoint;
}
bool is_transmit_size(std::uint32_t offset) { return offset == otg.dieptxf0 || otg.dieptxf.covers(offset); }
/// Returns true if `offset` is the control register or the transfer-size register of the IN endpoint. The interrupt
/// register is excluded, because the firmware may clear interrupt flags at any time.
bool is_of_in(std::uint32_t offset, unsigned endpoint) {
  const std::uint32_t of_device = offset - otg_device_base;
  return (otg.diepctl.covers(of_device) && otg.diepctl.index(of_device) == endpoint) ||
         (otg.dieptsiz.covers(of_device) && otg.dieptsiz.index(of_device) == endpoint);
}
bool is_of_out(std::uint32_t offset, unsigned endpoint) {
  const std::uint32_t of_device = offset - otg_device_base;
  return (otg.doepctl.covers(of_device) && otg.doepctl.index(of_device) == endpoint) ||
         (otg.doeptsiz.covers(of_device) && otg.doeptsiz.index(of_device) == endpoint);
}

}  // namespace

std::uint32_t OtgFsDevice::reset_control() const {
  const Ticks now = scheduler_.now();
  const bool resets = now < core_reset_until_, flushes = now < transmit_flush_until_;
  return otg.grstctl.csrst.with(resets) | otg.grstctl.ahbidl.with(!resets) |
         otg.grstctl.rxfflsh.with(now < receive_flush_until_) | otg.grstctl.txfflsh.with(flushes) |
         otg.grstctl.txfnum.with(flushes ? fifo_flushed_ : 0);
}

void OtgFsDevice::write_reset_control(std::uint32_t value) {
  const Ticks now = scheduler_.now();
  if (otg.grstctl.csrst.in(value)) {
    reset_since_selection_ = otg.gusbcfg.physel.in(usb_configuration_);
    reset_core();
    core_reset_until_ = now + core_reset_duration;
    return;
  }
  check_flush(value);
  if (otg.grstctl.rxfflsh.in(value)) {
    receive_.clear();
    receive_data_words_ = 0;
    setup_stage_open_ = setup_done_unpopped_ = setup_done_lost_ = false;
    receive_flush_until_ = now + command_duration;
  }
  if (otg.grstctl.txfflsh.in(value)) {
    fifo_flushed_ = otg.grstctl.txfnum.of(value);
    transmit_flush_until_ = now + command_duration;
    for (unsigned i = 0; i < endpoint_count; ++i)
      if (is_flushed(i)) flush_transmit(i);
    if (fifo_flushed_ != all_transmit_fifos && fifo_flushed_ >= endpoint_count) rules_.violate(Rule::usb_no_such_fifo);
  }
}

bool OtgFsDevice::is_flushed(unsigned fifo) const {
  return fifo_flushed_ == all_transmit_fifos || fifo_flushed_ == fifo;
}

void OtgFsDevice::flush_transmit(unsigned number) {
  transmit_[number].clear();
  for (unsigned i = 0; i < endpoint_count; ++i) {
    if (transmit_fifo_of(i) != number) continue;
    in_[i].packet_words_to_load = 0;
    in_[i].packets_in_fifo = 0;
    in_[i].damaged = false;
    in_[i].bytes_on_wire.reset();
  }
}

void OtgFsDevice::check_flush(std::uint32_t value) {
  const bool may_receive = pulled_up_ && !bus_is_silent_ && !global_out_nak_effective_ && !reset_is_unseen();
  if (otg.grstctl.rxfflsh.in(value) && may_receive) rules_.violate(Rule::usb_flush_in_use, "receive FIFO");
  if (!otg.grstctl.txfflsh.in(value)) return;
  const unsigned number = otg.grstctl.txfnum.of(value);
  for (unsigned i = 0; i < endpoint_count; ++i) {
    const InEndpoint& endpoint = in_[i];
    if (number != all_transmit_fifos && transmit_fifo_of(i) != number) continue;
    const bool may_send = otg.diepctl.epena.in(endpoint.control) && !otg.diepctl.naksts.in(endpoint.control) &&
                          otg.diepctl.usbaep.in(endpoint.control) && !global_in_nak_;
    if (may_send || free_of_packet(endpoint) > scheduler_.now())
      rules_.violate(Rule::usb_flush_in_use, "IN " + std::to_string(i));
  }
}

// --- NAK and disabling ------------------------------------------------------------------------------------

// Returns the time at which the packet on the wire ends, or 0 if no packet is on the wire.
Ticks OtgFsDevice::free_of_packet(const InEndpoint& endpoint) const {
  return endpoint.bytes_on_wire ? endpoint.wire_until : 0;
}

void OtgFsDevice::let_nak_take_effect(InEndpoint& endpoint) {
  scheduler_.cancel(endpoint.nak_event);
  const Ticks when = std::max(scheduler_.now() + command_duration, free_of_packet(endpoint));
  endpoint.nak_event = scheduler_.at(when, [this, &endpoint] {
    endpoint.interrupts |= otg.diepint.inepne.mask();
    update_interrupt();
  });
}

void OtgFsDevice::disable_in(InEndpoint& endpoint) {
  endpoint.disabling = true;
  scheduler_.cancel(endpoint.disable_event);
  const Ticks when = std::max(scheduler_.now() + command_duration, free_of_packet(endpoint));
  endpoint.disable_event = scheduler_.at(when, [this, &endpoint] {
    endpoint.disabling = false;
    endpoint.control &= ~otg.diepctl.epena.mask();
    endpoint.interrupts |= otg.diepint.epdisd.mask();
    endpoint.bytes_on_wire.reset();
    update_interrupt();
  });
}

void OtgFsDevice::disable_out(OutEndpoint& endpoint) {
  endpoint.disable_pending = false;
  endpoint.disabling = true;
  scheduler_.cancel(endpoint.disable_event);
  endpoint.disable_event = scheduler_.at(scheduler_.now() + command_duration, [this, &endpoint] {
    endpoint.disabling = false;
    endpoint.control &= ~otg.doepctl.epena.mask();
    endpoint.interrupts |= otg.doepint.epdisd.mask();
    update_interrupt();
  });
}

void OtgFsDevice::cancel_commands() {
  for (const InEndpoint& endpoint : in_) {
    scheduler_.cancel(endpoint.nak_event);
    scheduler_.cancel(endpoint.disable_event);
  }
  for (const OutEndpoint& endpoint : out_) scheduler_.cancel(endpoint.disable_event);
  core_reset_until_ = receive_flush_until_ = transmit_flush_until_ = 0;
}

// --- Early register writes --------------------------------------------------------------------------------

bool OtgFsDevice::store_may_come(std::uint32_t offset, std::uint32_t value) {
  const Ticks now = scheduler_.now();
  if (core_reset_until_ != 0 && now < core_reset_until_ + rest_after_reset) {
    rules_.violate(Rule::usb_disturbed, "core reset");
    return now >= core_reset_until_;
  }
  if (now < receive_flush_until_ && (offset == otg.grstctl || offset == otg.grxfsiz))
    rules_.violate(Rule::usb_disturbed, "flush of the receive FIFO");
  if (now < transmit_flush_until_) check_flushed_fifo(offset, value);
  check_disabled_endpoints(offset, value);
  return true;
}

void OtgFsDevice::check_flushed_fifo(std::uint32_t offset, std::uint32_t value) {
  bool concerned = offset == otg.grstctl || is_transmit_size(offset);
  for (unsigned i = 0; i < endpoint_count; ++i) {
    if (!is_flushed(transmit_fifo_of(i))) continue;
    const bool enables =
        is_of_in(offset, i) && otg.diepctl.covers(offset - otg_device_base) && otg.diepctl.epena.in(value);
    concerned |= enables || is_fifo_of(offset, i);
  }
  if (concerned) rules_.violate(Rule::usb_disturbed, "flush of a transmit FIFO");
}

void OtgFsDevice::check_disabled_endpoints(std::uint32_t offset, std::uint32_t value) {
  const bool flushes = offset == otg.grstctl && otg.grstctl.txfflsh.in(value);
  for (unsigned i = 0; i < endpoint_count; ++i) {
    const unsigned flushed = otg.grstctl.txfnum.of(value);
    const bool loses_fifo = flushes && (flushed == all_transmit_fifos || flushed == transmit_fifo_of(i));
    const bool fills_fifo = is_fifo_of(offset, i);
    if (in_[i].disabling && (is_of_in(offset, i) || loses_fifo || fills_fifo))
      rules_.violate(Rule::usb_disturbed, "IN " + std::to_string(i) + " is being disabled");
    if (out_[i].disabling && is_of_out(offset, i))
      rules_.violate(Rule::usb_disturbed, "OUT " + std::to_string(i) + " is being disabled");
  }
}

}  // namespace inkwell::virtual_board
