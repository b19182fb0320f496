// Processor side of the OTG_FS core: endpoint registers and FIFO windows.
#include <algorithm>

#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"

#include "boards/stm32f405/otg_fs/otg_fs_map.hpp"

namespace inkwell::virtual_board {

namespace {

/// Longest allowed time from the check for an empty receive FIFO to the write that clears NAK.
constexpr Ticks check_before_clearing_nak = ticks_per_s / 1'000'000;

constexpr std::uint32_t stored_in_bits(unsigned endpoint) {
  const auto& control = otg.diepctl;
  const std::uint32_t common = control.mpsiz.mask() | control.txfnum.mask();
  return endpoint == 0 ? common : common | control.usbaep.mask() | control.eptyp.mask();
}

constexpr std::uint32_t stored_out_bits(unsigned endpoint) {
  const auto& control = otg.doepctl;
  const std::uint32_t common = control.mpsiz.mask() | control.snpm.mask();
  return endpoint == 0 ? common : common | control.usbaep.mask() | control.eptyp.mask();
}

// Endpoint 0 has narrower size and packet count fields than other endpoints.
constexpr std::uint32_t transfer_bytes(std::uint32_t size, unsigned endpoint) {
  return otg.dieptsiz.xfrsiz.of(size) & (endpoint == 0 ? 0x7F : otg.dieptsiz.xfrsiz.maximum());
}
constexpr std::uint32_t in_packets(std::uint32_t size, unsigned endpoint) {
  return otg.dieptsiz.pktcnt.of(size) & (endpoint == 0 ? 3 : otg.dieptsiz.pktcnt.maximum());
}
constexpr std::uint32_t out_packets(std::uint32_t size, unsigned endpoint) {
  return otg.doeptsiz.pktcnt.of(size) & (endpoint == 0 ? 1 : otg.doeptsiz.pktcnt.maximum());
}

}  // namespace

// --- IN: to the host --------------------------------------------------------------------------------------

std::uint32_t OtgFsDevice::read_in_endpoint(std::uint32_t offset) {
  if (otg.diepctl.covers(offset)) {
    const unsigned number = otg.diepctl.index(offset);
    return in_[number].control | otg.diepctl.dpid.with(number != 0 && in_[number].data1);
  }
  if (otg.diepint.covers(offset)) return in_interrupts(otg.diepint.index(offset));
  if (otg.dieptsiz.covers(offset)) {
    const InEndpoint& endpoint = in_[otg.dieptsiz.index(offset)];
    return otg.dieptsiz.pktcnt.with(endpoint.packets) | otg.dieptsiz.xfrsiz.with(endpoint.bytes_to_load);
  }
  if (otg.dtxfsts.covers(offset))
    return otg.dtxfsts.ineptfsav.with(static_cast<std::uint32_t>(transmit_words_free(otg.dtxfsts.index(offset))));
  return not_modelled(otg_device_base + offset, false, 0);
}

void OtgFsDevice::write_in_endpoint(std::uint32_t offset, std::uint32_t value) {
  if (otg.diepctl.covers(offset)) {
    write_in_control(otg.diepctl.index(offset), value);
  } else if (otg.diepint.covers(offset)) {
    in_[otg.diepint.index(offset)].interrupts &= ~value;
  } else if (otg.dieptsiz.covers(offset)) {
    const unsigned number = otg.dieptsiz.index(offset);
    InEndpoint& endpoint = in_[number];
    if (otg.diepctl.epena.in(endpoint.control) && !otg.diepctl.naksts.in(endpoint.control))
      rules_.violate(Rule::usb_size_while_enabled);
    endpoint.packets = in_packets(value, number);
    endpoint.bytes_to_load = endpoint.bytes_to_send = transfer_bytes(value, number);
    endpoint.packet_words_to_load = 0;
    endpoint.bytes_on_wire.reset();
  } else {
    not_modelled(otg_device_base + offset, true, value);
  }
}

void OtgFsDevice::write_in_control(unsigned number, std::uint32_t value) {
  InEndpoint& endpoint = in_[number];
  const std::uint32_t stored = stored_in_bits(number),
                      chooses_fifo = otg.diepctl.usbaep.mask() | otg.diepctl.txfnum.mask();
  layout_changed_ |= ((endpoint.control ^ value) & stored & chooses_fifo) != 0;
  endpoint.control = (endpoint.control & ~stored) | (value & stored);
  if (number == 0)
    endpoint.control |= value & otg.diepctl.stall.mask();  // the firmware can only set STALL; a SETUP packet clears it
  else
    endpoint.control = (endpoint.control & ~otg.diepctl.stall.mask()) | (value & otg.diepctl.stall.mask());
  if (otg.diepctl.cnak.in(value)) {
    endpoint.control &= ~otg.diepctl.naksts.mask();
    endpoint.interrupts &= ~otg.diepint.inepne.mask();
    scheduler_.cancel(endpoint.nak_event);
  }
  if (otg.diepctl.snak.in(value)) {
    endpoint.control |= otg.diepctl.naksts.mask();
    let_nak_take_effect(endpoint);
  }
  if (number != 0 && otg.diepctl.sd0pid.in(value)) endpoint.data1 = false;
  if (number != 0 && otg.diepctl.sd1pid.in(value)) endpoint.data1 = true;
  if (otg.diepctl.epdis.in(value)) {
    if (otg.diepctl.epena.in(endpoint.control))
      disable_in(endpoint);
    else
      rules_.violate(Rule::usb_disable_without_enable);
  } else if (otg.diepctl.epena.in(value) && !otg.diepctl.epena.in(endpoint.control)) {
    endpoint.control |= otg.diepctl.epena.mask();
    check_in_transfer(number);
  }
}

void OtgFsDevice::check_in_transfer(unsigned number) {
  const InEndpoint& endpoint = in_[number];
  const std::uint32_t where = otg_device_base + otg.diepctl + number * otg.diepctl.stride;
  const unsigned maximum = in_packet_maximum(number);
  if (endpoint.packets == 0) rules_.violate(Rule::usb_no_packets, "IN " + std::to_string(number));
  if (endpoint.bytes_to_send > endpoint.packets * maximum) rules_.violate(Rule::usb_bytes_beyond_packets);
  if (!otg.diepctl.usbaep.in(endpoint.control) && !reset_is_unseen())
    rules_.violate(Rule::usb_inactive_endpoint, "IN " + std::to_string(number));
  if (otg.diepctl.eptyp.of(endpoint.control) == otg_control && number != 0)
    rules_.violate(Rule::usb_endpoint_type, "IN " + std::to_string(number));
  if (otg.diepctl.eptyp.of(endpoint.control) == otg_isochronous && number != 0)
    note("isochronous endpoints are not modeled", where, true, endpoint.control);
  if (!transmit_[transmit_fifo_of(number)].empty()) rules_.violate(Rule::usb_stale_words);
  if (transmit_depth(transmit_fifo_of(number)) * 4 < std::min<std::size_t>(endpoint.bytes_to_send, maximum))
    rules_.violate(Rule::usb_fifo_too_small);
  note_memory_layout();
}

void OtgFsDevice::push_transmit_data(unsigned number, std::uint32_t word) {
  InEndpoint& endpoint = in_[number];
  const unsigned fifo_number = transmit_fifo_of(number);
  WordFifo& fifo = transmit_[fifo_number];

  if (endpoint.packet_words_to_load != 0 && writing_endpoint_ != number && !endpoint.damaged) {
    // As observed on silicon, the core repeatedly sends the packet with a bad CRC until the FIFO is flushed.
    rules_.violate(Rule::usb_interleaved);
    endpoint.damaged = true;
  }
  writing_endpoint_ = number;
  if (fifo.count() >= transmit_depth(fifo_number)) {
    rules_.violate(Rule::usb_fifo_full);
    return;
  }
  if (!otg.diepctl.epena.in(endpoint.control)) rules_.violate(Rule::usb_fifo_before_enable);

  const bool level_before = transmit_empty_level(number);
  fifo.push(word);
  if (endpoint.packet_words_to_load == 0) {
    endpoint.packet_bytes_loading = std::min<std::uint32_t>(endpoint.bytes_to_load, in_packet_maximum(number));
    endpoint.packet_words_to_load = words_for(endpoint.packet_bytes_loading);
    if (endpoint.packet_words_to_load == 0) {
      rules_.violate(Rule::usb_words_beyond_transfer);
      return;
    }
  }
  if (--endpoint.packet_words_to_load == 0) {
    endpoint.bytes_to_load -= endpoint.packet_bytes_loading;
    ++endpoint.packets_in_fifo;
    constexpr unsigned packets_that_the_core_counts = 8;
    if (endpoint.packets_in_fifo > packets_that_the_core_counts) {
      rules_.violate(Rule::usb_fifo_packets, "IN " + std::to_string(number));
      endpoint.damaged = true;
    }
  }
  if (level_before != transmit_empty_level(number)) update_interrupt();
}

unsigned OtgFsDevice::in_packet_maximum(unsigned endpoint) const {
  const std::uint32_t field = otg.diepctl.mpsiz.of(in_[endpoint].control);
  return endpoint == 0 ? 64u >> (field & 3) : field;
}

unsigned OtgFsDevice::transmit_fifo_of(unsigned endpoint) const {
  const unsigned number = otg.diepctl.txfnum.of(in_[endpoint].control);
  return endpoint == 0 || number >= endpoint_count ? 0 : number;
}

std::size_t OtgFsDevice::transmit_depth(unsigned number) const {
  return std::min<std::size_t>(otg.dieptxf.ineptxfd.of(transmit_size_[number]), packet_memory_words);
}

std::size_t OtgFsDevice::transmit_words_free(unsigned endpoint) const {
  const unsigned fifo = transmit_fifo_of(endpoint);
  const std::size_t depth = transmit_depth(fifo);
  return depth - std::min(depth, transmit_[fifo].count());
}

bool OtgFsDevice::transmit_empty_level(unsigned endpoint) const {
  const unsigned fifo = transmit_fifo_of(endpoint);
  const std::size_t level = otg.gahbcfg.txfelvl.in(bus_configuration_) ? 0 : transmit_depth(fifo) / 2;
  return transmit_[fifo].count() <= level;
}

// FIFO regions must not overlap in the packet memory. The core does not detect an overlap.
void OtgFsDevice::note_memory_layout() {
  if (!layout_changed_) return;
  layout_changed_ = false;
  struct Region {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  std::array<Region, endpoint_count + 1> regions{};
  regions[0].end = receive_size_;
  for (unsigned i = 0; i < endpoint_count; ++i) {
    if (i != 0 && !otg.diepctl.usbaep.in(in_[i].control)) continue;
    const std::uint32_t size_register = transmit_size_[transmit_fifo_of(i)];
    const std::size_t begin = otg.dieptxf.ineptxsa.of(size_register);
    regions[i + 1] = {begin, begin + otg.dieptxf.ineptxfd.of(size_register)};
  }
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].end > packet_memory_words) rules_.violate(Rule::usb_memory_exceeded);
    for (std::size_t j = 0; j < i; ++j)
      if (regions[i].begin < regions[j].end && regions[j].begin < regions[i].end)
        rules_.violate(Rule::usb_memory_overlap);
  }
}

// --- OUT: from the host -----------------------------------------------------------------------------------

std::uint32_t OtgFsDevice::read_out_endpoint(std::uint32_t offset) {
  if (otg.doepctl.covers(offset)) {
    const unsigned number = otg.doepctl.index(offset);
    if (number == 0) return out_[0].control | (in_[0].control & 3);  // both directions have the same packet size
    return out_[number].control | otg.doepctl.dpid.with(out_[number].data1);
  }
  if (otg.doepint.covers(offset)) return out_[otg.doepint.index(offset)].interrupts;
  if (otg.doeptsiz.covers(offset)) {
    const unsigned number = otg.doeptsiz.index(offset);
    return otg.doeptsiz.pktcnt.with(out_[number].packets) | otg.doeptsiz.xfrsiz.with(out_[number].bytes) |
           otg.doeptsiz.stupcnt.with(number == 0 ? setup_packets_allowed_ : 0);
  }
  return not_modelled(otg_device_base + offset, false, 0);
}

void OtgFsDevice::write_out_endpoint(std::uint32_t offset, std::uint32_t value) {
  if (otg.doepctl.covers(offset)) {
    write_out_control(otg.doepctl.index(offset), value);
  } else if (otg.doepint.covers(offset)) {
    out_[otg.doepint.index(offset)].interrupts &= ~value;
  } else if (otg.doeptsiz.covers(offset)) {
    const unsigned number = otg.doeptsiz.index(offset);
    // Firmware may write DOEPTSIZ0 while endpoint 0 is enabled, because DOEPTSIZ0 contains the SETUP packet count.
    if (number != 0 && otg.doepctl.epena.in(out_[number].control))
      rules_.violate(Rule::usb_out_size_while_enabled, "OUT " + std::to_string(number));
    out_[number].packets = out_packets(value, number);
    out_[number].bytes = transfer_bytes(value, number);
    if (number == 0) setup_packets_allowed_ = otg.doeptsiz.stupcnt.of(value);
  } else {
    not_modelled(otg_device_base + offset, true, value);
  }
}

void OtgFsDevice::write_out_control(unsigned number, std::uint32_t value) {
  OutEndpoint& endpoint = out_[number];
  const std::uint32_t stored = stored_out_bits(number);
  endpoint.control = (endpoint.control & ~stored) | (value & stored);
  if (number == 0)
    endpoint.control |= value & otg.doepctl.stall.mask();
  else
    endpoint.control = (endpoint.control & ~otg.doepctl.stall.mask()) | (value & otg.doepctl.stall.mask());
  if (otg.doepctl.cnak.in(value)) {
    if (number == 0) lose_setup_done_word();
    endpoint.control &= ~otg.doepctl.naksts.mask();
  }
  if (otg.doepctl.snak.in(value)) endpoint.control |= otg.doepctl.naksts.mask();
  if (number != 0 && otg.doepctl.sd0pid.in(value)) endpoint.data1 = false;
  if (number != 0 && otg.doepctl.sd1pid.in(value)) endpoint.data1 = true;
  if (otg.doepctl.epdis.in(value)) {
    if (number == 0 || !otg.doepctl.epena.in(endpoint.control)) {
      rules_.violate(Rule::usb_out_disable);
    } else if (global_out_nak_effective_) {
      disable_out(endpoint);
    } else {
      rules_.violate(Rule::usb_out_disable_early);
      endpoint.disable_pending = true;
    }
  } else if ((otg.doepctl.epena.in(value) || armed_by_cnak(number, value)) && !otg.doepctl.epena.in(endpoint.control)) {
    endpoint.control |= otg.doepctl.epena.mask();
    check_out_transfer(number);
  }
}

// The manual requires firmware to set EPENA and CNAK together. Existing drivers, for example in ChibiOS, start an OUT
// transfer with CNAK alone. The real core accepts packets after CNAK alone.
bool OtgFsDevice::armed_by_cnak(unsigned number, std::uint32_t control_written) const {
  const OutEndpoint& endpoint = out_[number];
  const bool clears_nak =
      (control_written & (otg.doepctl.cnak.mask() | otg.doepctl.snak.mask())) == otg.doepctl.cnak.mask();
  return clears_nak && (number == 0 || (otg.doepctl.usbaep.in(endpoint.control) && endpoint.packets != 0));
}

void OtgFsDevice::check_out_transfer(unsigned number) {
  const OutEndpoint& endpoint = out_[number];
  const std::uint32_t where = otg_device_base + otg.doepctl + number * otg.doepctl.stride;
  if (endpoint.packets == 0 && number != 0) rules_.violate(Rule::usb_no_packets, "OUT " + std::to_string(number));
  if (number == 0) return;
  const std::uint32_t maximum = otg.doepctl.mpsiz.of(endpoint.control);
  if (maximum == 0 || endpoint.bytes == 0 || endpoint.bytes % maximum != 0) rules_.violate(Rule::usb_out_size);
  if (!otg.doepctl.usbaep.in(endpoint.control) && !reset_is_unseen())
    rules_.violate(Rule::usb_inactive_endpoint, "OUT " + std::to_string(number));
  if (otg.doepctl.eptyp.of(endpoint.control) == otg_control)
    rules_.violate(Rule::usb_endpoint_type, "OUT " + std::to_string(number));
  if (otg.doepctl.eptyp.of(endpoint.control) == otg_isochronous)
    note("isochronous endpoints are not modeled", where, true, endpoint.control);
}

// As observed on silicon, the setup-done word of a SETUP packet is lost if NAK on endpoint 0 is cleared before the word
// is popped. Firmware cannot avoid the loss if the packet arrives just after the last check of the FIFO.
void OtgFsDevice::lose_setup_done_word() {
  if (!setup_done_unpopped_ || setup_done_lost_) return;
  const bool checked = scheduler_.now() - receive_found_empty_at_ <= check_before_clearing_nak;
  if (setup_was_seen_ || !checked) rules_.violate(Rule::usb_nak_cleared_early);
  setup_done_lost_ = true;
}

void OtgFsDevice::note_receive_fifo_check() {
  if (receive_.empty())
    receive_found_empty_at_ = scheduler_.now();
  else
    setup_was_seen_ = true;
}

std::uint32_t OtgFsDevice::pop_receive_status() {
  if (receive_.empty()) {
    rules_.violate(Rule::usb_pop_empty);
    return 0;
  }
  if (receive_data_words_ != 0) {
    rules_.violate(Rule::usb_pop_before_data);
    --receive_data_words_;
    const std::uint32_t word = receive_.pop();
    update_interrupt();
    return word;
  }
  note_receive_fifo_check();
  const std::uint32_t word = receive_.pop();
  const unsigned number = otg.grxstsp.epnum.of(word);
  switch (otg.grxstsp.pktsts.of(word)) {
    case PacketStatus::global_out_nak:
      global_out_nak_effective_ = global_out_nak_requested_;
      if (global_out_nak_effective_)
        for (OutEndpoint& endpoint : out_)
          if (endpoint.disable_pending) disable_out(endpoint);
      break;
    case PacketStatus::out_data:
    case PacketStatus::setup_data: receive_data_words_ = words_for(otg.grxstsp.bcnt.of(word)); break;
    case PacketStatus::out_done:
      out_[number].control &= ~otg.doepctl.epena.mask();
      out_[number].interrupts |= otg.doepint.xfrc.mask();
      break;
    case PacketStatus::setup_done:
      setup_done_unpopped_ = false;
      if (setup_done_lost_) {
        setup_done_lost_ = false;
        update_interrupt();
        return receive_.empty() ? 0 : pop_receive_status();
      }
      out_[0].control &= ~otg.doepctl.epena.mask();
      out_[0].interrupts |= otg.doepint.stup.mask();
      break;
    default: break;
  }
  update_interrupt();
  return word;
}

std::uint32_t OtgFsDevice::pop_receive_data() {
  if (receive_data_words_ == 0) {
    rules_.violate(Rule::usb_read_beyond_packet);
    return 0;
  }
  --receive_data_words_;
  const std::uint32_t word = receive_.pop();
  if (receive_.empty()) update_interrupt();
  return word;
}

}  // namespace inkwell::virtual_board
