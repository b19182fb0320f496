// Bus side of the OTG_FS core: line states and transactions.
#include <algorithm>
#include <cstring>

#include "boards/stm32f405/otg_fs/bit_stuffing.hpp"
#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"

#include "boards/stm32f405/otg_fs/otg_fs_map.hpp"

namespace inkwell::virtual_board {

namespace {
/// Reserved words of the receive FIFO: ten for SETUP packets and one for the global OUT NAK (RM0090, "Peripheral FIFO
/// architecture").
constexpr std::size_t reserved_receive_words = 11;
constexpr Ticks frame_ticks = ticks_per_s / 1000;
/// Longest time from the loss of VBUS to the release of the pull-up (USB 2.0, section 7.1.5).
constexpr Ticks pull_up_release = 10 * ticks_per_s;
/// Bit times from an IN token to the end of the handshake time-out, excluding the data and stuffed bits.
constexpr Ticks in_transaction_bits = 8 * 14;

/// End of the periodic part of a frame, in thousandths of a frame (DCFG.PFIVL).
unsigned periodic_frame_per_mille(std::uint32_t device_configuration) {
  return 800 + 50 * otg.dcfg.pfivl.of(device_configuration);
}
}  // namespace

void OtgFsDevice::set_bus_power(bool present) {
  const bool sensed =
      (core_configuration_ & (otg.gccfg.vbusbsen.mask() | otg.gccfg.novbussens.mask())) == otg.gccfg.vbusbsen.mask();
  if (sensed && bus_power_ && !present) otg_interrupts_ |= otg.gotgint.sedet.mask();
  if (sensed && !bus_power_ && present) latched_interrupts_ |= otg.gintsts.srqint.mask();
  bus_power_ = present;
  scheduler_.cancel(pull_up_check_);
  if (!present) pull_up_check_ = scheduler_.at(scheduler_.now() + pull_up_release, [this] { check_bus_power(); });
  update_pull_up();
  update_interrupt();
}

void OtgFsDevice::check_bus_power() {
  if (pulled_up_ && !bus_power_) rules_.violate(Rule::usb_pull_up_unpowered);
}

// At a bus reset the core clears only USBAEP in the endpoint registers. Enable bits, stall bits and FIFOs do not change
// until the firmware clears them.
void OtgFsDevice::begin_reset() {
  bus_is_silent_ = true;
  suspended_ = false;
  latched_interrupts_ |= otg.gintsts.usbrst.mask();
  for (unsigned i = 0; i < endpoint_count; ++i) {
    if (i != 0) {
      in_[i].control &= ~otg.diepctl.usbaep.mask();
      out_[i].control &= ~otg.doepctl.usbaep.mask();
    }
    in_[i].bytes_on_wire.reset();
    in_[i].wire_until = 0;
  }
  setup_stage_open_ = false;
  setup_done_unpopped_ = setup_done_lost_ = false;
  control_transfer_open_ = false;
  address_ = programmed_address();
  update_interrupt();
}

void OtgFsDevice::end_reset() {
  bus_is_silent_ = false;
  check_core();
  latched_interrupts_ |= otg.gintsts.enumdne.mask();
  update_interrupt();
}

void OtgFsDevice::start_of_frame(std::uint16_t frame_number) {
  suspended_ = false;
  frame_number_ = frame_number;
  latched_interrupts_ |= otg.gintsts.sof.mask();
  triggers_.usb_start_of_frame();
  if (otg.gintmsk.eopfm.in(interrupt_mask_)) {
    const Ticks length = frame_ticks * periodic_frame_per_mille(device_configuration_) / 1000;
    end_of_periodic_frame_ = scheduler_.at(scheduler_.now() + length, [this] {
      latched_interrupts_ |= otg.gintsts.eopf.mask();
      update_interrupt();
    });
  } else {
    latched_interrupts_ |= otg.gintsts.eopf.mask();  // the exact time does not matter without this interrupt
  }
  update_interrupt();
}

void OtgFsDevice::suspend() {
  suspended_ = true;
  latched_interrupts_ |= otg.gintsts.esusp.mask() | otg.gintsts.usbsusp.mask();
  update_interrupt();
}

void OtgFsDevice::resume() {
  suspended_ = false;
  latched_interrupts_ |= otg.gintsts.wkupint.mask();
  update_interrupt();
}

bool OtgFsDevice::answers(unsigned address, unsigned endpoint) const {
  const bool addressed = address == address_ || (control_transfer_open_ && address == programmed_address());
  const bool phy_clock_runs = !otg.pcgcctl.stppclk.in(power_control_);
  return pulled_up_ && addressed && endpoint < endpoint_count && clock_is_exact() && phy_clock_runs;
}

std::size_t OtgFsDevice::receive_depth() const { return std::min<std::size_t>(receive_size_, packet_memory_words); }

std::size_t OtgFsDevice::receive_words_free() const {
  return receive_depth() - std::min(receive_depth(), receive_.count());
}

void OtgFsDevice::push_status(unsigned endpoint, unsigned packet_status, std::size_t bytes, bool data1) {
  const auto& status = otg.grxstsp;
  receive_.push(status.epnum.with(endpoint) | status.bcnt.with(static_cast<std::uint32_t>(bytes)) |
                status.dpid.with(data1 ? 2 : 0) | status.pktsts.with(packet_status) |
                status.frmnum.with(frame_number_));
}

void OtgFsDevice::push_data(std::span<const std::byte> data) {
  for (std::size_t i = 0; i < data.size(); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, data.data() + i, std::min<std::size_t>(4, data.size() - i));
    receive_.push(word);
  }
}

// SETUP packets are always accepted, regardless of NAK and STALL. A SETUP packet sets NAK in both directions of
// endpoint 0.
Handshake OtgFsDevice::setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> request) {
  if (endpoint != 0 || !answers(address, endpoint)) return Handshake::nothing;
  check_turnaround();
  constexpr std::size_t words = 1 + 2;
  if (receive_words_free() < words) {
    rules_.violate(Rule::usb_no_room_for_setup);
    return Handshake::nothing;
  }
  if (control_transfer_open_) address_ = address;
  control_transfer_open_ = true;
  push_status(0, PacketStatus::setup_data, request.size(), false);
  push_data(request);
  setup_stage_open_ = true;
  setup_done_unpopped_ = true;
  setup_done_lost_ = false;
  setup_was_seen_ = false;
  if (setup_packets_allowed_ > 0)
    --setup_packets_allowed_;
  else
    out_[0].interrupts |= otg.doepint.b2bstup.mask();
  in_[0].control = (in_[0].control & ~otg.diepctl.stall.mask()) | otg.diepctl.naksts.mask();
  out_[0].control = (out_[0].control & ~otg.doepctl.stall.mask()) | otg.doepctl.naksts.mask();
  in_[0].data1 = out_[0].data1 = true;
  in_[0].bytes_on_wire.reset();
  update_interrupt();
  return Handshake::ack;
}

// The next token ends the setup stage, because no further SETUP packet can follow.
void OtgFsDevice::end_setup_stage() {
  if (!setup_stage_open_) return;
  setup_stage_open_ = false;
  if (setup_done_lost_) {
    setup_done_lost_ = setup_done_unpopped_ = false;
    out_[0].control &= ~otg.doepctl.epena.mask();
  } else {
    push_status(0, PacketStatus::setup_done, 0, false);
  }
  update_interrupt();
}

Handshake OtgFsDevice::out(unsigned address, unsigned number, bool data1, std::span<const std::byte> data) {
  if (!answers(address, number)) return Handshake::nothing;
  OutEndpoint& endpoint = out_[number];
  if (!otg.doepctl.usbaep.in(endpoint.control)) return Handshake::nothing;
  if (number == 0) end_setup_stage();
  if (otg.doepctl.stall.in(endpoint.control)) return Handshake::stall;
  const bool enabled = otg.doepctl.epena.in(endpoint.control);
  if (!enabled && number == 0) {
    endpoint.interrupts |= otg.doepint.otepdis.mask();
    update_interrupt();
  }
  // The empty packet of a status stage is accepted even if PKTCNT is 0.
  const bool is_expected = endpoint.packets != 0 || (number == 0 && data.empty());
  if (!enabled || otg.doepctl.naksts.in(endpoint.control) || !is_expected || global_out_nak_requested_)
    return Handshake::nak;
  const std::size_t words = 1 + words_for(data.size()) + 1;  // status, data, and transfer-complete status
  if (receive_words_free() < words + reserved_receive_words) return Handshake::nak;
  if (data1 != endpoint.data1) return Handshake::ack;  // a repetition, because the acknowledgment was lost

  const std::size_t maximum = number == 0 ? in_packet_maximum(0) : otg.doepctl.mpsiz.of(endpoint.control);
  if (data.size() > maximum) return Handshake::nothing;
  if (data.size() > endpoint.bytes) rules_.violate(Rule::usb_out_overrun);
  push_status(number, PacketStatus::out_data, data.size(), endpoint.data1);
  push_data(data);
  endpoint.data1 = !endpoint.data1;
  if (endpoint.packets != 0) --endpoint.packets;
  endpoint.bytes -= static_cast<std::uint32_t>(std::min<std::size_t>(endpoint.bytes, data.size()));
  if (endpoint.packets == 0 || data.size() < maximum) {
    endpoint.control |= otg.doepctl.naksts.mask();  // EPENA is cleared when the firmware pops the word
    push_status(number, PacketStatus::out_done, 0, false);
  }
  update_interrupt();
  return Handshake::ack;
}

InReply OtgFsDevice::in(unsigned address, unsigned number, std::span<std::byte, full_speed_packet_maximum> data) {
  if (!answers(address, number)) return {};
  InEndpoint& endpoint = in_[number];
  if (!otg.diepctl.usbaep.in(endpoint.control)) return {};
  if (number == 0) end_setup_stage();
  if (otg.diepctl.stall.in(endpoint.control)) return {Handshake::stall};

  const WordFifo& fifo = transmit_[transmit_fifo_of(number)];
  const std::uint32_t bytes = std::min<std::uint32_t>(endpoint.bytes_to_send, in_packet_maximum(number));
  const bool enabled = otg.diepctl.epena.in(endpoint.control) && endpoint.packets != 0;
  const bool held = otg.diepctl.naksts.in(endpoint.control) || global_in_nak_ || endpoint.disabling;
  if (!enabled || held || fifo.count() < words_for(bytes)) {
    if (fifo.empty() && (!enabled || bytes != 0)) {
      endpoint.interrupts |= otg.diepint.ittxfe.mask();
      update_interrupt();
    }
    return {Handshake::nak};
  }
  if (endpoint.damaged) return {};
  for (std::uint32_t i = 0; i < bytes; i += 4) {
    const std::uint32_t word = fifo.at(i / 4);
    std::memcpy(data.data() + i, &word, std::min<std::uint32_t>(4, bytes - i));
  }
  endpoint.bytes_on_wire = bytes;
  const Ticks stuffed = stuffed_bits(endpoint.data1, std::span<const std::byte>(data).first(bytes));
  endpoint.wire_until = scheduler_.now() + (in_transaction_bits + 8 * bytes + stuffed) * bit_ticks;
  return {Handshake::ack, endpoint.data1, bytes};
}

bool OtgFsDevice::finish_in(unsigned number) {
  InEndpoint& endpoint = in_[number];
  if (!endpoint.bytes_on_wire || scheduler_.now() > endpoint.wire_until) return false;
  const std::uint32_t bytes = *endpoint.bytes_on_wire;
  endpoint.bytes_on_wire.reset();
  endpoint.wire_until = 0;
  transmit_[transmit_fifo_of(number)].drop(words_for(bytes));
  endpoint.bytes_to_send -= bytes;
  if (bytes != 0 && endpoint.packets_in_fifo != 0) --endpoint.packets_in_fifo;
  --endpoint.packets;
  endpoint.data1 = !endpoint.data1;
  if (endpoint.packets == 0) {
    endpoint.control &= ~otg.diepctl.epena.mask();
    endpoint.interrupts |= otg.diepint.xfrc.mask();
  }
  if (number == 0 && bytes == 0) {  // status stage of a request without data to the host
    control_transfer_open_ = false;
    address_ = programmed_address();
  }
  update_interrupt();
  return true;
}

}  // namespace inkwell::virtual_board
